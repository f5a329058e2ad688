// SPDX-License-Identifier: Apache-2.0
// Pictures of a mesh.
#pragma once

#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

enum class MeshColoring {
  Shaded,   ///< plain clay
  Normal,   ///< direction of the normal in the camera: x, y, z as red, green, blue
  Support,  ///< by mesh.support: orange where the surface was invented, then from dark to light with more
            ///< views
  Values,   ///< by RenderOptions::values, dark blue to yellow
  Vertex,   ///< the mesh's own colours
};

struct RenderOptions {
  MeshColoring coloring = MeshColoring::Shaded;
  /// A vertex each, for MeshColoring::Values.
  std::vector<float> values;
  /// What the two ends of the colours stand for. For Support only `high` matters. Empty (low = high): the
  /// smallest and largest value.
  double low = 0, high = 0;
  enum class Normals { Interpolated, Flat };
  /// Flat shows every triangle as it is.
  Normals normals = Normals::Interpolated;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< in the world, towards the sky's light
  Rgb8 background{255, 255, 255};
  /// Rays a pixel along each axis.
  int supersampling = 2;
};

/// Everything that is wrong with the options for this mesh, one sentence each.
std::vector<std::string> validate(const RenderOptions& options, const TriangleMesh& mesh);

/// What the sensor of `view` sees of the mesh, lit from the sensor and from the sky. Triangles seen from
/// their inner side come out violet: the mesh is open there, or inside out. Same bytes for every number of
/// threads. Throws InvalidArgument listing all of validate(options, mesh).
Image<Rgb8> render(const TriangleMesh& mesh, const ViewHeader& view, const RenderOptions& options = {});

/// A pinhole camera that just shows all of the mesh, from the front (frontFor(up)), a little from its right
/// and from above. REQUIRES: a mesh with extent; `up` a unit vector.
ViewHeader framingCamera(const TriangleMesh& mesh, const Eigen::Vector3d& up, int width, int height);

/// The same from another side, turned by `angle` (radians) around `up`.
ViewHeader framingCamera(const TriangleMesh& mesh, const Eigen::Vector3d& up, int width, int height,
                         double angle);

/// Pictures of the mesh from `count` sides, a full turn around options.up, in rows of about as many columns
/// as rows, from the top left; each of width × height pixels. REQUIRES: count > 0.
Image<Rgb8> renderTurntable(const TriangleMesh& mesh, int count, int width, int height,
                            const RenderOptions& options = {});

/// A camera with a field of view of 40° along the longer side of its image.
ViewHeader cameraLookingAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
                           const Eigen::Vector3d& up, int width, int height);

}  // namespace vdbfuse
