// SPDX-License-Identifier: Apache-2.0
// Minimum cut of a network, exact, in integers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/mincut/network.h"

namespace vdbfuse {

enum class CutSide : std::uint8_t { Sink, Source };

/// Plateaus of the capacities make many cuts minimum. Their source sides are closed under union and
/// intersection, so there is exactly one smallest and exactly one largest.
enum class CutTies : std::uint8_t {
  SmallestSource,  ///< a node is on the source side only if it is so in every minimum cut
  LargestSource,   ///< a node is on the sink side only if it is so in every minimum cut
};

struct SolveOptions {
  /// Which of several minimum cuts comes back. A node that reaches neither terminal is on the sink side with
  /// SmallestSource and on the source side with LargestSource.
  CutTies ties = CutTies::SmallestSource;
};

/// How much work a solve was. Counts, no times: the same network and flow give the same numbers, on one
/// thread and on several (which differ from one, because regions are solved first).
struct SolveStatistics {
  std::uint64_t regions = 0;    ///< parts that were solved on their own before the whole; 0 on one thread
  std::uint64_t passes = 0;     ///< levels by which one of the forests grew
  std::uint64_t tiles = 0;      ///< tiles looked at in growth
  std::uint64_t scans = 0;      ///< nodes of theirs that were to be looked at
  std::uint64_t bridges = 0;    ///< arcs between the forests that were filled
  std::uint64_t pushes = 0;     ///< arcs of the forests that flow was pushed along
  std::uint64_t adoptions = 0;  ///< orphans that found a parent
  std::uint64_t releases = 0;   ///< orphans that left their forest
  std::size_t bytes = 0;        ///< memory of the solver besides the network, its result included
};

/// A minimum cut. The flow that proves it stays in the network (see verify.h).
struct MinCut {
  /// A tile each: its nodes on the source side. Bits of empty slots are 0.
  std::vector<std::uint64_t> source;
  /// Value of the maximum flow == capacity of the cut.
  std::int64_t flow = 0;
  SolveStatistics statistics;

  CutSide side(std::uint32_t node) const {
    const std::uint64_t tile = source[node / lattice::kSlots];
    return (tile >> node % lattice::kSlots & 1) != 0 ? CutSide::Source : CutSide::Sink;
  }
};

/// Finds a minimum cut, starting from the flow that the network carries and leaving a maximum one in it.
/// Deterministic: the labels do not depend on the number of threads, on the flow at the start or on the order
/// of nodes and edges, ties being defined. Throws Cancelled when `progress` asks to stop; the network then
/// carries a valid flow, and another solve() goes on from there.
///
/// Incremental breadth-first search with excesses, after Goldberg, Hed, Kaplan, Tarjan, Werneck, "Maximum
/// flows by incremental breadth-first search", ESA 2011, and Goldberg, Hed, Kaplan, Kohli, Tarjan, Werneck,
/// "Faster and more dynamic maximum flow by incremental breadth-first search", ESA 2015. Three things differ:
/// no more is pushed from one side than it can supply, so that the loop ends for all capacities; forests are
/// mended in batches; and fronts are sets of bits, so that a tile of 64 nodes is scanned in a few shifts.
/// On several threads large networks are first solved in regions, each on a thread (the first phase of
/// Shekhovtsov and Hlaváč, "A distributed mincut/maxflow algorithm combining path augmentation and
/// push-relabel", IJCV 2013), then as a whole.
MinCut solve(Network& network, const SolveOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
