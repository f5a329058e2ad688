// SPDX-License-Identifier: Apache-2.0
#include "lattice_edges.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse::mincut {
namespace {

[[noreturn]] void refuse(std::uint32_t tile, std::uint32_t slot, const std::string& what_is_wrong) {
  throw InvalidArgument(
      "tiles", "tile " + std::to_string(tile) + ", slot " + std::to_string(slot) + " " + what_is_wrong);
}

/// Writes the terminals; Σ max(terminal, 0).
std::uint64_t fillTerminals(State& state, std::uint32_t t, const TileCapacities& values) {
  std::uint64_t supply = 0;
  for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {
    const bool is_node = (state.tiles[t].nodes >> slot & 1) != 0;
    const std::int64_t terminal = is_node ? values.terminal[slot] : 0;
    state.excess[std::size_t{t} * lattice::kSlots + slot] = terminal;
    supply += static_cast<std::uint64_t>(std::max<std::int64_t>(terminal, 0));
  }
  return supply;
}

/// Writes the residuals of all forward arcs of the tile and of their mates, zeros where there is no edge. The
/// backward arcs on a face that meets no tile are all that is left: nobody else would write them.
void fillResiduals(State& state, std::uint32_t t, const TileCapacities& values) {
  const std::uint32_t none = state.tileCount();
  for (int d = 1; d < lattice::kDirections; d += 2) {
    const int back = lattice::opposite(d);
    const auto axis = static_cast<std::size_t>(d / 2);
    const std::uint64_t edges = latticeEdges(state, t, d);
    for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {
      const std::uint32_t node = t * lattice::kSlots + slot;
      const bool edge = (edges >> slot & 1) != 0;
      const auto value = [&](std::int32_t capacity) {
        return edge ? static_cast<std::uint32_t>(capacity) : 0;
      };
      state.residual[State::latticeArc(node, d)] = value(values.forward[axis][slot]);
      const std::uint32_t other = state.neighbour(node, d);
      if (tileOf(other) != none)
        state.residual[State::latticeArc(other, back)] = value(values.backward[axis][slot]);
      const bool outermost = (lattice::leavingDirections(slot) >> back & 1) != 0;
      if (outermost && state.tiles[t].next[back] == none) state.residual[State::latticeArc(node, back)] = 0;
    }
  }
}

void openTile(State& state, std::uint32_t t) {
  for (int d = 0; d < lattice::kDirections; ++d) {
    std::uint64_t open = 0;
    for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {
      const bool has_room = state.residual[State::latticeArc(t * lattice::kSlots + slot, d)] > 0;
      open |= static_cast<std::uint64_t>(has_room) << slot;
    }
    state.tiles[t].open[d] = open;
  }
}

}  // namespace

void askForTile(const NetworkSource& source, const State& state, std::uint32_t tile, TileCapacities& values) {
  source.capacities(tile, values);
  for (std::uint64_t nodes = state.tiles[tile].nodes; nodes != 0; nodes &= nodes - 1) {
    const auto slot = static_cast<std::uint32_t>(std::countr_zero(nodes));
    const std::int64_t terminal = values.terminal[slot];
    if (terminal > kLargestTerminal || terminal < -kLargestTerminal)
      refuse(tile, slot, "has the terminal " + std::to_string(terminal) + ", beyond 2^56");
  }
  forEachLatticeEdge(state, tile, values,
                     [&](std::uint32_t node, std::uint32_t, int, std::int32_t there, std::int32_t back) {
                       const std::int32_t smaller = std::min(there, back);
                       if (smaller < 0)
                         refuse(tile, slotOf(node), "has the negative capacity " + std::to_string(smaller));
                     });
}

void fillTiles(const NetworkSource& source, State& state) {
  const std::size_t count = state.tileCount();
  state.excess = Buffer<std::int64_t>((count + 1) * lattice::kSlots);
  if (state.has_lattice)
    state.residual = Buffer<std::uint32_t>(count * lattice::kDirections * lattice::kSlots);
  std::fill(state.excess.end() - lattice::kSlots, state.excess.end(), 0);
  std::atomic<std::uint64_t> supply = 0;
  parallelFor(count, kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    TileCapacities values;
    for (auto t = static_cast<std::uint32_t>(begin); t < end; ++t) {
      values = {};
      askForTile(source, state, t, values);
      supply += fillTerminals(state, t, values);
      if (state.has_lattice) fillResiduals(state, t, values);
    }
  });
  state.supply = supply;
  if (!state.has_lattice) return;
  parallelFor(count, kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) openTile(state, static_cast<std::uint32_t>(t));
  });
}

}  // namespace vdbfuse::mincut
