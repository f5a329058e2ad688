// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/solve.h"

#include "forests.h"

namespace vdbfuse {

MinCut solve(const Network& network, const SolveOptions& options, const Progress& progress) {
  progress.report("minimum cut", 0.0);
  mincut::Forests forests(network, progress);
  forests.maximiseFlow();
  if (options.ties == CutTies::SmallestSource) {
    forests.exhaust<mincut::Tree::Source>();
  } else {
    forests.exhaust<mincut::Tree::Sink>();
  }
  progress.report("minimum cut", 1.0);
  return forests.takeResult(options.ties);
}

}  // namespace vdbfuse
