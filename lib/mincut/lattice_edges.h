// SPDX-License-Identifier: Apache-2.0
// What the tiles bring: terminals and the capacities of lattice edges.
#pragma once

#include <cstdint>

#include "state.h"

namespace vdbfuse::mincut {

inline constexpr std::size_t kTilesPerTask = 256;

/// Slots of the tile that have a neighbour in this direction, and an edge to it.
inline std::uint64_t latticeEdges(const State& state, std::uint32_t tile, int direction) {
  const Tile& here = state.tiles[tile];
  const std::uint64_t beyond = state.tiles[here.next[direction]].nodes;
  return here.nodes & lattice::stepInto(here.nodes, beyond, lattice::opposite(direction));
}

/// Asks the source for one tile. Throws InvalidArgument, naming the tile, for values that cannot be.
void askForTile(const NetworkSource& source, const State& state, std::uint32_t tile, TileCapacities& values);

/// Calls visit(from, to, direction, capacity, reverse_capacity) for the lattice edges that a tile owns.
template <typename Visit>
void forEachLatticeEdge(const State& state, std::uint32_t tile, const TileCapacities& values,
                        const Visit& visit) {
  if (!state.has_lattice) return;
  for (int d = 1; d < lattice::kDirections; d += 2) {
    const auto axis = static_cast<std::size_t>(d / 2);
    for (std::uint64_t slots = latticeEdges(state, tile, d); slots != 0; slots &= slots - 1) {
      const std::uint32_t node = lowestNode(tile, slots), slot = slotOf(node);
      visit(node, state.neighbour(node, d), d, values.forward[axis][slot], values.backward[axis][slot]);
    }
  }
}

/// Allocates excesses and residuals and fills them with what the source says, no flow yet.
void fillTiles(const NetworkSource& source, State& state);

/// Sets the bit that says whether the arc has residual.
inline void refreshOpen(State& state, std::uint32_t node, int direction) {
  std::uint64_t& open = state.tiles[tileOf(node)].open[direction];
  open = state.residual[State::latticeArc(node, direction)] > 0 ? open | bitOf(node) : open & ~bitOf(node);
}

}  // namespace vdbfuse::mincut
