// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/solve.h"

#include <algorithm>
#include <atomic>

#include "exhaust.h"
#include "forests.h"
#include "regions.h"
#include "roots.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using mincut::ForestNodes;
using mincut::Forests;
using mincut::State;
using mincut::Tile;

/// Tiles of a region, a quarter of a million nodes. The same for any number of threads but one, which needs
/// none.
constexpr std::uint32_t kRegion = 4096;

void add(const SolveStatistics& part, SolveStatistics& sum) {
  sum.passes += part.passes;
  sum.tiles += part.tiles;
  sum.scans += part.scans;
  sum.bridges += part.bridges;
  sum.pushes += part.pushes;
  sum.adoptions += part.adoptions;
  sum.releases += part.releases;
  sum.bytes += part.bytes;
}

/// Solves each region with nothing but its own nodes.
template <bool Reversed>
SolveStatistics solveRegions(State& state, ForestNodes& nodes, const Progress& progress) {
  const std::size_t count = chunkCount(state.tileCount(), kRegion);
  std::vector<SolveStatistics> parts(count);
  parallelFor(state.tileCount(), kRegion, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<std::uint32_t>(begin), last = static_cast<std::uint32_t>(end);
    mincut::settleNeighbours(state, first, last);
    for (std::uint32_t tile = first; tile < last; ++tile) Forests<Reversed>::plantTile(state, nodes, tile);
    const mincut::ClosedRegion closed(state, first, last);
    Forests<Reversed> forests(state, nodes, first, last, progress);
    forests.maximiseFlow();
    parts[begin / kRegion] = forests.statistics();
  });
  SolveStatistics sum;
  for (const SolveStatistics& part : parts) add(part, sum);
  sum.regions = count;
  sum.bytes = 0;  // given back before the whole is solved
  return sum;
}

/// Solves all of it, from the flow that there is.
template <bool Reversed>
SolveStatistics solveWhole(State& state, ForestNodes& nodes, const Progress& progress) {
  mincut::settleNeighbours(state, 0, state.tileCount());
  parallelFor(state.tileCount(), kRegion, [&](std::size_t begin, std::size_t end) {
    for (auto tile = static_cast<std::uint32_t>(begin); tile < end; ++tile)
      Forests<Reversed>::plantTile(state, nodes, tile);
  });
  Forests<Reversed> forests(state, nodes, 0, state.tileCount(), progress);
  forests.maximiseFlow();
  return forests.statistics();
}

template <bool Reversed>
SolveStatistics maximiseFlow(State& state, const Progress& progress) {
  ForestNodes nodes(state);
  SolveStatistics sum;
  if (threadCount() > 1 && state.tileCount() > kRegion) {
    sum = solveRegions<Reversed>(state, nodes, progress);
    mincut::markRoots(state);
  }
  add(solveWhole<Reversed>(state, nodes, progress), sum);
  sum.bytes += nodes.level.size() * sizeof(std::int32_t) + nodes.parent.size() +
               nodes.listed_parent.size() * sizeof(std::uint32_t);
  return sum;
}

/// Modulo 2⁶⁴ on the way, because the sum of all supplies need not fit.
std::int64_t flowValue(const State& state) {
  std::atomic<std::uint64_t> left_over = 0;
  parallelFor(state.tileCount(), kRegion, [&](std::size_t begin, std::size_t end) {
    std::uint64_t sum = 0;
    for (std::size_t node = begin * lattice::kSlots; node < end * lattice::kSlots; ++node)
      sum += static_cast<std::uint64_t>(std::max<std::int64_t>(state.excess[node], 0));
    left_over += sum;
  });
  return static_cast<std::int64_t>(state.supply - left_over);
}

}  // namespace

MinCut solve(Network& network, const SolveOptions& options, const Progress& progress) {
  State& state = network.state();
  progress.report("minimum cut", 0.0);
  MinCut cut;
  // The giver should be the side that has more: its roots are seldom used up, each on its own, and those of
  // the taker, which are, are used up by loads that travel together.
  const bool reversed = mincut::markRoots(state) < 0;
  cut.statistics = reversed ? maximiseFlow<true>(state, progress) : maximiseFlow<false>(state, progress);
  const bool smallest = options.ties == CutTies::SmallestSource;
  mincut::exhaust(state, smallest ? mincut::Side::Source : mincut::Side::Sink);
  cut.source.reserve(state.tileCount());
  for (std::uint32_t t = 0; t < state.tileCount(); ++t) {
    const Tile& tile = state.tiles[t];
    cut.source.push_back(smallest ? tile.source : tile.nodes & ~tile.sink);
  }
  cut.flow = flowValue(state);
  cut.statistics.bytes += cut.source.size() * sizeof(std::uint64_t);
  progress.report("minimum cut", 1.0);
  return cut;
}

}  // namespace vdbfuse
