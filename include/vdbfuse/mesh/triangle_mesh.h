// SPDX-License-Identifier: Apache-2.0
// An indexed triangle mesh. Counter-clockwise seen from outside; 32-bit indices.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

using Triangle = std::array<std::uint32_t, 3>;

struct TriangleMesh {
  std::vector<Eigen::Vector3f> vertices;  ///< world coordinates
  std::vector<Triangle> triangles;
  /// A vertex each, or empty.
  std::vector<Eigen::Vector3f> normals;
  std::vector<Rgb8> colors;
  /// Number of views that agree with the surface at this vertex; 0 where it was invented.
  std::vector<float> support;
  /// 1 − ρ = 1 − e^(−μ support) in [0, 1]: 0 where the surface was invented.
  std::vector<float> confidence;
  /// What a reader of the file should know, a line each, without line ends.
  std::vector<std::string> comments;
};

Box boundingBox(const TriangleMesh& mesh);

/// Sum of the areas of all triangles.
double area(const TriangleMesh& mesh);

/// A third of the area of the triangles around each vertex, a vertex each.
std::vector<double> vertexAreas(const TriangleMesh& mesh);

/// Volume enclosed by a closed mesh; negative when it is inside out.
double signedVolume(const TriangleMesh& mesh);

/// Removes vertices that belong to no triangle, with their attributes.
void dropUnusedVertices(TriangleMesh& mesh);

/// Appends a vertex like `vertex`, with all its attributes, and returns its number.
std::uint32_t appendCopy(TriangleMesh& mesh, std::uint32_t vertex);

/// Area-weighted unit normals, a vertex each; zero for a vertex without area.
std::vector<Eigen::Vector3f> vertexNormals(const TriangleMesh& mesh);

}  // namespace vdbfuse
