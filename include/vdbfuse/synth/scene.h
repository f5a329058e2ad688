// SPDX-License-Identifier: Apache-2.0
// Shapes whose surface is known, for scans whose truth is known. Every scene is scaled so that its bounding
// box has a diagonal of 1 and its centre at the origin. World +z is up, and the front looks towards −y,
// unless stated.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// Signed distance to a surface: > 0 outside. May understate the distance (never overstate it).
using SignedDistance = std::function<double(const Eigen::Vector3d&)>;

struct CylinderShape {
  Eigen::Vector3d from, to;  ///< centres of the two discs
  double radius = 0;
};
struct SphereShape {
  Eigen::Vector3d center;
  double radius = 0;
};
using SceneRegionShape = std::variant<Box, CylinderShape, SphereShape>;

/// On which side of the surface a region should end up.
enum class RegionSide { Inside, Outside };

/// The core of a named part of a scene: well away from the surface, so that it asks whether the part is
/// there, not whether its surface is exact.
struct SceneRegion {
  std::string name;
  RegionSide expect = RegionSide::Inside;
  SceneRegionShape shape;
};

bool contains(const SceneRegionShape& shape, const Eigen::Vector3d& point);

struct Scene {
  std::string name;
  TriangleMesh truth;  ///< closed, counter-clockwise seen from outside
  /// Empty for scenes made of a mesh; there the mesh itself is the truth.
  SignedDistance distance;
  std::vector<SceneRegion> regions;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d front =
      -Eigen::Vector3d::UnitY();  ///< direction from the centre to a camera that sees the front
};

/// Names makeScene() knows: sphere, box, torus, figure, occluder, and ball: a sphere with a diameter, not a
/// diagonal, of 1, so that in metres it is the one on which fusion programs have been compared.
std::vector<std::string> sceneNames();

/// How finely scenes defined by a signed distance are meshed.
struct SceneOptions {
  /// Edge of a meshing cell, in diagonals of the scene. Smaller: more triangles (about 4/cell² for `figure`),
  /// more time. Vertices lie on the surface whatever it is.
  double cell = 1.0 / 320;
};

/// A scene defined by its signed distance. `figure` is the test of this project, all in parts of its height:
/// legs 0.04 thick, and a cavity in the chest that opens to the front, 0.1 wide and high and 0.2 deep.
/// `occluder` is for stereo: a wall behind a row of posts that hide about half of it, another half from every
/// direction. Throws InvalidArgument for an unknown name or cell ≤ 0.
Scene makeScene(const std::string& name, const SceneOptions& options = {});

/// A scene made of a closed mesh, moved and scaled as stated above. Throws InvalidArgument for a mesh without
/// triangles or extent.
Scene sceneFromMesh(std::string name, TriangleMesh mesh);

/// Half the extents of the room of inRoom(), in diagonals of the object.
inline const Eigen::Vector3d kRoomHalfSize{1.8, 1.8, 1.2};
inline constexpr double kRoomWall = 0.1;  ///< thickness of its walls

/// The scene floating in the middle of a closed room; the truth becomes object and walls, the walls solid.
Scene inRoom(Scene object);

}  // namespace vdbfuse
