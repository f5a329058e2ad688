// SPDX-License-Identifier: Apache-2.0
// The cells of an octree in tiles: blocks of 4³ cells of one level, as the minimum cut's network wants them
// (mincut/lattice.h). Neighbours of equal size are found by shifting bits; neighbours of unequal size are
// listed.
#pragma once

#include <cstdint>
#include <vector>

#include "vdbfuse/mincut/network.h"
#include "vdbfuse/octree/octree.h"

namespace vdbfuse {

inline constexpr std::uint32_t kNoCell = 0xffffffff;

/// Two nodes that share a face of the finer one, which is half as wide.
struct CellTransition {
  std::uint32_t fine = 0, coarse = 0;
  std::uint8_t direction = 0;  ///< from fine to coarse: −x, +x, −y, +y, −z, +z
};

struct CellTiles {
  /// In the order in which the octree's cells first enter them, so that tiles near each other in space are
  /// near each other in memory; tiles of different levels mixed.
  std::vector<NetworkTile> tiles;
  std::vector<std::uint8_t> levels;  ///< a tile each
  /// 64 a tile: the octree's cell in the slot, or kNoCell.
  std::vector<std::uint32_t> cells;
  std::vector<CellTransition> transitions;  ///< by fine node

  std::uint32_t count() const { return static_cast<std::uint32_t>(tiles.size()); }
};

/// Throws InvalidArgument for 2³² cells or 2²⁵ tiles and more.
CellTiles tileCells(const Octree& octree);

}  // namespace vdbfuse
