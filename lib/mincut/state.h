// SPDX-License-Identifier: Apache-2.0
// The arrays of a network and the flow in it.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "buffer.h"
#include "vdbfuse/mincut/lattice.h"
#include "vdbfuse/mincut/network.h"

namespace vdbfuse::mincut {

/// Two cache lines; the first holds all that a step of a whole front needs.
struct alignas(64) Tile {
  std::uint64_t open[lattice::kDirections] = {};  ///< nodes whose lattice edge in this direction has residual
  std::uint64_t source = 0;                       ///< nodes in the source forest
  std::uint64_t sink = 0;                         ///< nodes in the sink forest
  std::uint64_t nodes = 0;
  std::uint64_t joined = 0;                       ///< nodes with listed edges
  std::uint32_t next[lattice::kDirections] = {};  ///< tiles beyond the faces; tileCount(): none
  std::uint32_t first_row = 0;                    ///< row of the first joined node
};

constexpr std::uint32_t tileOf(std::uint32_t node) { return node / lattice::kSlots; }
constexpr std::uint32_t slotOf(std::uint32_t node) { return node % lattice::kSlots; }
constexpr std::uint64_t bitOf(std::uint32_t node) { return std::uint64_t{1} << slotOf(node); }

/// The node in the lowest slot of a set. REQUIRES: slots != 0.
constexpr std::uint32_t lowestNode(std::uint32_t tile, std::uint64_t slots) {
  return tile * lattice::kSlots + static_cast<std::uint32_t>(std::countr_zero(slots));
}

/// `count` tiles without nodes, and one more: it stands for what is beyond. No arc of it is open, and all of
/// it is marked as source, so that it is neither free nor a sink.
Buffer<Tile> emptyTiles(std::uint32_t count);

/// The arcs from `first` up to `last`, to loop over. clang++ 14 does not compile std::views::iota.
struct ArcRange {
  struct Iterator {
    std::uint32_t arc;
    std::uint32_t operator*() const { return arc; }
    Iterator& operator++() {
      ++arc;
      return *this;
    }
    bool operator==(const Iterator&) const = default;
  };
  std::uint32_t first, last;
  Iterator begin() const { return {first}; }
  Iterator end() const { return {last}; }
};

struct State {
  Buffer<Tile> tiles;              ///< see emptyTiles()
  Buffer<std::uint32_t> residual;  ///< of lattice arcs: 6 · 64 a tile, by direction, then by slot
  Buffer<std::int64_t> excess;     ///< 64 a tile: terminal + inflow − outflow
  // Listed edges in compressed rows: one row a joined node, two arcs an edge, each the other's mate.
  std::vector<std::uint32_t> row_starts{0};
  Buffer<std::uint32_t> heads, mates, arc_residual;
  std::uint64_t supply = 0;  ///< Σ max(terminal, 0), modulo 2⁶⁴
  bool has_lattice = false;

  std::uint32_t tileCount() const { return static_cast<std::uint32_t>(tiles.size() - 1); }
  static std::size_t latticeArc(std::uint32_t node, int direction) {
    return (std::size_t{tileOf(node)} * lattice::kDirections + static_cast<unsigned>(direction)) *
               lattice::kSlots +
           slotOf(node);
  }
  bool isJoined(std::uint32_t node) const { return (tiles[tileOf(node)].joined & bitOf(node)) != 0; }
  /// REQUIRES: isJoined(node).
  std::uint32_t row(std::uint32_t node) const {
    const Tile& tile = tiles[tileOf(node)];
    return tile.first_row + static_cast<std::uint32_t>(std::popcount(tile.joined & (bitOf(node) - 1)));
  }
  /// In this direction, or in the tile without nodes if there is nothing.
  std::uint32_t neighbour(std::uint32_t node, int direction) const {
    const std::uint32_t slot = slotOf(node);
    const std::uint32_t beyond = tiles[tileOf(node)].next[direction];  // a branch would be guessed wrong
    const bool leaves = (lattice::leavingDirections(slot) >> direction & 1) != 0;
    return (leaves ? beyond : tileOf(node)) * lattice::kSlots + lattice::neighbourSlot(slot, direction);
  }
  /// The listed arcs of a joined node.
  ArcRange arcs(std::uint32_t node) const {
    const std::uint32_t r = row(node);
    return {row_starts[r], row_starts[r + 1]};
  }
};

}  // namespace vdbfuse::mincut
