// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/solve.h"

#include "forests.h"

namespace vdbfuse {
namespace {

using mincut::Forests;
using mincut::Orientation;
using mincut::Tree;

/// The source forest should be the one with fewer roots (see forests.h).
Orientation betterOrientation(const Network& network) {
  std::int64_t supplies_more = 0;
  for (std::uint32_t node = 0; node < network.nodeCount(); ++node) {
    supplies_more += (network.terminal(node) > 0) - (network.terminal(node) < 0);
  }
  return supplies_more > 0 ? Orientation::Reversed : Orientation::AsGiven;
}

}  // namespace

MinCut solve(const Network& network, const SolveOptions& options, const Progress& progress) {
  progress.report("minimum cut", 0.0);
  const Orientation orientation = betterOrientation(network);
  Forests forests(network, orientation, progress);
  forests.maximiseFlow();
  if ((options.ties == CutTies::SmallestSource) == (orientation == Orientation::AsGiven)) {
    forests.exhaust<Tree::Source>();
  } else {
    forests.exhaust<Tree::Sink>();
  }
  progress.report("minimum cut", 1.0);
  return forests.takeResult(options.ties);
}

}  // namespace vdbfuse
