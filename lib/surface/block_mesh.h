// SPDX-License-Identifier: Apache-2.0
// A part of a surface as a mesh of its own: the leaves of one block.
#pragma once

#include <array>

#include "surface/leaf_mesh.h"
#include "vdbfuse/surface/live_surface.h"

namespace vdbfuse {

/// Leaves along a block, and along the neighbourhood that its mesh depends on: one below it and one above it
/// that have triangles at its vertices, and one more above whose vertices those use.
inline constexpr int kBlockLeaves = LiveSurface::kBlockSide / ScalarGrid::kLeafSide;
inline constexpr int kAroundBlock = kBlockLeaves + 3;

/// Where a leaf of the neighbourhood lies in it; (1, 1, 1) is the block's first.
inline std::size_t placeAround(int x, int y, int z) {
  return static_cast<std::size_t>((x * kAroundBlock + y) * kAroundBlock + z);
}

/// By placeAround(); null where there is no leaf.
using BlockNeighbourhood = std::array<const LeafMesh*, kAroundBlock * kAroundBlock * kAroundBlock>;

/// The triangles of the block's own leaves, with the vertices that they use and area-weighted unit normals.
/// What blocks share, vertices on their borders and the normals there, is the same to the last bit in each.
TriangleMesh blockMesh(const BlockNeighbourhood& leaves);

}  // namespace vdbfuse
