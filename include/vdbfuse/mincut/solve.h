// SPDX-License-Identifier: Apache-2.0
// Minimum cut of a network, exact, in integers.
#pragma once

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

/// How much work a solve was. Counts, no times: the same network gives the same numbers.
struct SolveStatistics {
  std::uint64_t passes = 0;     ///< levels by which one of the forests grew
  std::uint64_t scans = 0;      ///< nodes looked at in growth
  std::uint64_t bridges = 0;    ///< arcs from the source forest to the sink forest that were filled
  std::uint64_t pushes = 0;     ///< arcs of the forests that flow was pushed along
  std::uint64_t adoptions = 0;  ///< orphans that found a parent
  std::uint64_t releases = 0;   ///< orphans that left their forest
  std::size_t bytes = 0;        ///< memory of the solver besides the network, its result included
};

/// A minimum cut and the pseudoflow that proves it (see verify.h).
struct MinCut {
  std::vector<CutSide> sides;  ///< one a node
  /// Value of the maximum flow == capacity of the cut.
  std::int64_t flow = 0;
  /// What each arc can still carry, in the network's order: residual[a] + residual[mate(a)] == capacity[a] +
  /// capacity[mate(a)]. Unsigned, because a residual reaches the sum of two 31-bit capacities.
  std::vector<std::uint32_t> residual;
  /// One a node: terminal plus what flows in minus what flows out. Positive only on the source side (supply
  /// that reaches no demand), negative only on the sink side (demand that is never met).
  std::vector<std::int64_t> excess;
  SolveStatistics statistics;
};

/// Finds a minimum cut. Deterministic: the labels do not depend on the number of threads (nor on the order of
/// nodes and edges, ties being defined). Throws Cancelled when `progress` asks to stop.
///
/// Incremental breadth-first search with excesses, after Goldberg, Hed, Kaplan, Tarjan, Werneck, "Maximum
/// flows by incremental breadth-first search", ESA 2011, and Goldberg, Hed, Kaplan, Kohli, Tarjan, Werneck,
/// "Faster and more dynamic maximum flow by incremental breadth-first search", ESA 2015. Two things differ:
/// no more is pushed from the source side than it can supply, so that the loop ends for all capacities, and
/// forests are mended in batches.
MinCut solve(const Network& network, const SolveOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
