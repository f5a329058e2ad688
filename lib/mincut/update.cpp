// SPDX-License-Identifier: Apache-2.0
// Other capacities under a flow that is kept.
#include <algorithm>

#include "lattice_edges.h"
#include "listed_edges.h"
#include "state.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/mincut/network.h"

namespace vdbfuse {
namespace {

using mincut::State;

[[noreturn]] void refuseBefore() {
  throw InvalidArgument("before", "is not what the network was built with or updated to");
}

/// Gives an edge that carries `flow` new capacities; what they do not allow becomes excess at its tail and
/// deficit at its head.
void setCapacities(State& state, const NetworkEdge& edge, std::int64_t flow, std::uint32_t& residual,
                   std::uint32_t& reverse_residual) {
  const std::int64_t kept =
      std::clamp<std::int64_t>(flow, -std::int64_t{edge.reverse_capacity}, edge.capacity);
  state.excess[edge.from] += flow - kept;
  state.excess[edge.to] -= flow - kept;
  residual = static_cast<std::uint32_t>(edge.capacity - kept);
  reverse_residual = static_cast<std::uint32_t>(edge.reverse_capacity + kept);
}

std::int64_t flowOf(const NetworkEdge& edge, std::int64_t residual, std::int64_t reverse_residual) {
  const std::int64_t flow = edge.capacity - residual;
  if (flow != reverse_residual - edge.reverse_capacity) refuseBefore();
  return flow;
}

void updateTile(State& state, std::uint32_t tile, const TileCapacities& before, const TileCapacities& after) {
  for (std::uint64_t nodes = state.tiles[tile].nodes; nodes != 0; nodes &= nodes - 1) {
    const auto slot = static_cast<std::uint32_t>(std::countr_zero(nodes));
    state.excess[std::size_t{tile} * lattice::kSlots + slot] += after.terminal[slot] - before.terminal[slot];
    state.supply += static_cast<std::uint64_t>(std::max<std::int64_t>(after.terminal[slot], 0) -
                                               std::max<std::int64_t>(before.terminal[slot], 0));
  }
  mincut::forEachLatticeEdge(
      state, tile, after,
      [&](std::uint32_t from, std::uint32_t to, int d, std::int32_t capacity, std::int32_t reverse_capacity) {
        const int back = lattice::opposite(d);
        std::uint32_t& residual = state.residual[State::latticeArc(from, d)];
        std::uint32_t& reverse_residual = state.residual[State::latticeArc(to, back)];
        const auto axis = static_cast<std::size_t>(d / 2);
        const std::uint32_t slot = mincut::slotOf(from);
        const NetworkEdge old = {from, to, before.forward[axis][slot], before.backward[axis][slot]};
        setCapacities(state, {from, to, capacity, reverse_capacity}, flowOf(old, residual, reverse_residual),
                      residual, reverse_residual);
        mincut::refreshOpen(state, from, d);
        mincut::refreshOpen(state, to, back);
      });
}

/// Two sweeps, because edges come from two sources: the first leaves the flow of an edge in its residual.
void updateListedEdges(State& state, const NetworkSource& before, const NetworkSource& after) {
  mincut::forEachListedEdge(state, before, [&](const NetworkEdge& edge, mincut::ArcCursor::Arcs arcs) {
    std::uint32_t& residual = state.arc_residual[arcs.arc];
    residual = static_cast<std::uint32_t>(flowOf(edge, residual, state.arc_residual[arcs.mate]));
  });
  mincut::forEachListedEdge(state, after, [&](const NetworkEdge& edge, mincut::ArcCursor::Arcs arcs) {
    const auto flow = static_cast<std::int32_t>(state.arc_residual[arcs.arc]);
    setCapacities(state, edge, flow, state.arc_residual[arcs.arc], state.arc_residual[arcs.mate]);
  });
}

}  // namespace

void updateNetwork(Network& network, const NetworkSource& before, const NetworkSource& after,
                   std::span<const std::uint32_t> changed) {
  State& state = network.state();
  std::vector<std::uint32_t> tiles(changed.begin(), changed.end());
  std::ranges::sort(tiles);
  tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
  for (const std::uint32_t tile : tiles) {
    if (tile >= state.tileCount())
      throw InvalidArgument("changed", "there is no tile " + std::to_string(tile));
    TileCapacities old_values, new_values;
    mincut::askForTile(before, state, tile, old_values);
    mincut::askForTile(after, state, tile, new_values);
    updateTile(state, tile, old_values, new_values);
  }
  updateListedEdges(state, before, after);
}

}  // namespace vdbfuse
