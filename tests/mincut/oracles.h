// SPDX-License-Identifier: Apache-2.0
// Solvers that have nothing in common with ours.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "mincut/instances.h"
#include "vdbfuse/mincut/solve.h"

namespace vdbfuse::test {

/// Value of the minimum cut, and the intersection and the union of all minimum source sides.
struct AllCuts {
  std::int64_t capacity = 0;
  std::vector<CutSide> smallest_source;
  std::vector<CutSide> largest_source;
};

/// Tries all 2ⁿ cuts of the terminals and edges as the caller gave them. REQUIRES: at most 24 nodes.
AllCuts tryAllCuts(const Instance& instance);

/// Boost's solvers, on a graph with two terminal nodes and compressed rows of edges. Splits the build from
/// the solve, so that each can be timed.
class BoostMaxFlow {
 public:
  enum class Algorithm { BoykovKolmogorov, PushRelabel };

  explicit BoostMaxFlow(const Instance& instance);
  ~BoostMaxFlow();
  BoostMaxFlow(const BoostMaxFlow&) = delete;
  BoostMaxFlow& operator=(const BoostMaxFlow&) = delete;
  std::int64_t solve(Algorithm algorithm = Algorithm::BoykovKolmogorov);

 private:
  struct Graph;
  std::unique_ptr<Graph> graph_;
};

}  // namespace vdbfuse::test
