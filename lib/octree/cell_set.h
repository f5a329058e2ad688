// SPDX-License-Identifier: Apache-2.0
// Sets of cells of one level, in tiles of 4³ cells (mincut/lattice.h): what the octree is built from.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vdbfuse/mincut/lattice.h"
#include "vdbfuse/octree/octree.h"

namespace vdbfuse {

/// Slot of a cell from the lowest six bits of its Morton code in units of the cell.
std::uint32_t slotOf(std::uint64_t code);

/// The cells of a tile: its Morton code in units of the tile, and a bit a cell.
struct CellWord {
  std::uint64_t code = 0, cells = 0;
};

/// Tiles with any cell, by increasing code, each once.
using CellSet = std::vector<CellWord>;

/// Sorts, and joins words of the same tile.
CellSet cellSet(std::vector<CellWord> words);
/// Of Morton codes in units of the cell, in increasing order.
CellSet cellSet(const std::vector<std::uint64_t>& codes);

std::size_t cellCount(const CellSet& set);
bool holds(const CellSet& set, std::uint64_t code);

/// All cells within one step of the given ones, corners included. `size`: of the domain in cells.
CellSet dilated(const CellSet& set, const Index3& size);
/// The cells twice as wide that hold one of the set.
CellSet parents(const CellSet& set);
/// The cells half as wide that make up the set.
CellSet children(const CellSet& set);
CellSet united(const CellSet& a, const CellSet& b);
CellSet without(const CellSet& set, const CellSet& taken);
/// All cells of a domain.
CellSet allCells(const Index3& size);

/// Calls visit(code) for all cells by increasing Morton code in units of the cell.
template <class Visit>
void forEachCell(const CellSet& set, const Visit& visit) {
  for (const CellWord& word : set) {
    for (std::uint64_t c = 0; c < lattice::kSlots; ++c)
      if ((word.cells >> slotOf(c) & 1) != 0) visit(word.code << 6 | c);
  }
}

}  // namespace vdbfuse
