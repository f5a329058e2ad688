// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// What the triangles of a mesh say about its connectivity. A triangle that names a vertex twice is counted
/// in `degenerate_triangles` and ignored everywhere else.
struct TopologyReport {
  std::size_t triangles = 0;           ///< proper ones, three different vertices
  std::size_t edges = 0;               ///< different edges of proper triangles
  std::size_t used_vertices = 0;       ///< vertices of at least one proper triangle
  std::size_t open_edges = 0;          ///< edges of one triangle
  std::size_t nonmanifold_edges = 0;   ///< edges of more than two triangles
  std::size_t inconsistent_edges = 0;  ///< edges that both their triangles run through in the same direction
  /// Vertices whose triangles form neither one closed fan of at least three nor one open fan.
  std::size_t nonmanifold_vertices = 0;
  std::size_t components = 0;            ///< sets of triangles connected by shared vertices
  std::ptrdiff_t euler_number = 0;       ///< used_vertices − edges + triangles
  std::size_t degenerate_triangles = 0;  ///< name a vertex twice
  std::size_t zero_area_triangles = 0;   ///< proper, but without area
  std::size_t nonfinite_vertices = 0;    ///< used or not
};

/// Counts all of it in linear time. InvalidArgument when a triangle names a vertex that does not exist.
TopologyReport topology(const TriangleMesh& mesh);

/// True for a surface that bounds a solid: at least one triangle, no open, non-manifold or inconsistently
/// oriented edge, no non-manifold vertex, no degenerate triangle, every vertex finite. Triangles without area
/// are allowed.
bool isClosedManifold(const TopologyReport& report);

}  // namespace vdbfuse
