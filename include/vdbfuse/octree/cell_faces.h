// SPDX-License-Identifier: Apache-2.0
// Faces of cells, from their tiles. They are visited and never listed: a list would be the largest thing of a
// reconstruction.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "vdbfuse/octree/cell_tiles.h"

namespace vdbfuse {

/// Two cells that share a face; `area` in finest faces h². cells.first is never the larger one.
struct CellFace {
  std::uint32_t first = 0, second = 0;
  std::uint8_t axis = 0;
  std::int8_t direction = 1;  ///< from first to second along the axis
  std::uint32_t area = 1;
};

/// Finest faces of a cell of this level.
inline std::uint32_t faceArea(std::uint8_t level) { return std::uint32_t{1} << 2 * level; }

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

inline CellFace faceOf(const CellTiles& tiles, std::uint32_t first, std::uint32_t second, int direction) {
  return {tiles.cells[first], tiles.cells[second], static_cast<std::uint8_t>(direction / 2),
          static_cast<std::int8_t>(lattice::isForward(direction) ? 1 : -1),
          faceArea(tiles.levels[first / lattice::kSlots])};
}

/// Calls visit(face) for every face between cells of equal size that tiles [begin, end) own. Those between
/// cells of unequal size are tiles.transitions: faceOf(tiles, t.fine, t.coarse, t.direction).
template <typename Visit>
void forEachEqualFace(const CellTiles& tiles, std::size_t begin, std::size_t end, const Visit& visit) {
  for (; begin < end; ++begin) {
    forEachEqualFace(tiles, static_cast<std::uint32_t>(begin),
                     [&](std::uint32_t node, std::uint32_t neighbour, int direction) {
                       visit(faceOf(tiles, node, neighbour, direction));
                     });
  }
}

/// Calls visit(face) for all pairs of cells that share a face, each once, in an order that does not depend on
/// threads.
template <typename Visit>
void forEachFace(const CellTiles& tiles, const Visit& visit) {
  forEachEqualFace(tiles, 0, tiles.count(), visit);
  for (const CellTransition& t : tiles.transitions) visit(faceOf(tiles, t.fine, t.coarse, t.direction));
}

}  // namespace vdbfuse
