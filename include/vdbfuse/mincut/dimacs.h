// SPDX-License-Identifier: Apache-2.0
// Maximum-flow problems in DIMACS format ("p max"), which other solvers read and write.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <vector>

#include "vdbfuse/mincut/network.h"

namespace vdbfuse {

struct MaxFlowProblem {
  std::vector<std::int64_t> terminals;  ///< a node each; without the source and the sink
  std::vector<NetworkEdge> edges;
  /// Flow that goes from the source to the sink in any case, and past the network: along arcs between the
  /// two, and through nodes that are joined with both. The maximum flow is this plus the network's.
  std::int64_t constant = 0;

  NetworkSource source() const { return graphSource(terminals, edges); }
};

/// Reads a problem; `path` is what errors call it. Nodes keep their order, source and sink left out; an arc
/// and its reverse in the next line become one edge; arcs into the source and out of the sink carry nothing
/// and are left out. Throws IoError, naming the line, for anything but such a file, for capacities beyond 2³¹
/// − 1 (2⁵⁶ at the source and the sink), and for arcs that are too few or too many.
MaxFlowProblem readDimacs(std::istream& input, const std::filesystem::path& path);

/// Writes a problem: nodes 1 … n in order, then the source and the sink. `constant` becomes an arc between
/// them.
void writeDimacs(const MaxFlowProblem& problem, std::ostream& output);

}  // namespace vdbfuse
