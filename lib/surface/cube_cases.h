// SPDX-License-Identifier: Apache-2.0
// The polygons in which a surface crosses a cube, for each of the 2⁸ ways its corners can lie inside or
// outside. Corner c lies at (c & 1, (c >> 1) & 1, c >> 2).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vdbfuse {

/// Edge e of a cube: from corner `base` one step along `axis`.
struct CubeEdge {
  int base = 0;
  int axis = 0;
};

/// The twelve edges, numbered axis by axis.
const std::array<CubeEdge, 12>& cubeEdges();

/// Vertices are named by the edge they lie on; kCentre is an extra vertex at the mean of a polygon's
/// vertices.
inline constexpr std::uint8_t kCentre = 12;

struct CubePolygon {
  std::vector<std::uint8_t> edges;  ///< counter-clockwise seen from outside
  /// Triangles over `edges`, none of whose inner sides lies in a face of the cube.
  std::vector<std::array<std::uint8_t, 3>> triangles;
  bool has_centre = false;  ///< some triangle uses kCentre
};

/// Polygons of a case; bit c of `inside` says that corner c is inside.
const std::vector<CubePolygon>& cubePolygons(std::uint8_t inside);

}  // namespace vdbfuse
