// SPDX-License-Identifier: Apache-2.0
// Faces of cells, from their tiles.
#pragma once

#include <bit>
#include <cstdint>

#include "vdbfuse/octree/cell_tiles.h"

namespace vdbfuse {

/// Calls visit(node, neighbour, direction) for the faces between cells of a tile and their equals in +x, +y,
/// +z.
template <typename Visit>
void forEachEqualFace(const CellTiles& tiles, std::uint32_t t, const Visit& visit) {
  const NetworkTile& tile = tiles.tiles[t];
  for (int d = 1; d < lattice::kDirections; d += 2) {
    const std::uint32_t next = tile.neighbours[static_cast<std::size_t>(d)];
    const std::uint64_t beyond = next == kNoTile ? 0 : tiles.tiles[next].nodes;
    std::uint64_t slots = tile.nodes & lattice::stepInto(tile.nodes, beyond, lattice::opposite(d));
    for (; slots != 0; slots &= slots - 1) {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(slots));
      const bool leaves = (lattice::leavingDirections(slot) >> d & 1) != 0;
      visit(t * lattice::kSlots + slot,
            (leaves ? next : t) * lattice::kSlots + lattice::neighbourSlot(slot, d), d);
    }
  }
}

/// Finest faces of a cell of this level.
inline std::uint16_t faceArea(std::uint8_t level) { return static_cast<std::uint16_t>(1u << 2 * level); }

}  // namespace vdbfuse
