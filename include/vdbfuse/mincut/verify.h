// SPDX-License-Identifier: Apache-2.0
// The certificate: a proof, checked in one sweep that shares no code with the search, that a cut is minimum.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vdbfuse/mincut/network.h"
#include "vdbfuse/mincut/solve.h"

namespace vdbfuse {

/// What verify() found.
struct CutReport {
  std::int64_t cut_capacity = 0;       ///< recomputed from the labels and the source alone
  std::int64_t flow = 0;               ///< recomputed from the source and the excesses
  std::uint64_t overfull_edges = 0;    ///< edges whose two residuals do not add up to their two capacities
  std::uint64_t unbalanced_nodes = 0;  ///< nodes whose excess is not terminal + inflow − outflow
  std::vector<std::string> problems;  ///< one sentence a kind of fault, naming the first place; empty: proven
  bool certified() const { return problems.empty(); }
};

/// Proves or refutes that `cut` is a minimum cut of what `source` says, with the flow in `network`.
///
/// The proof: let e(v) = terminal(v) + inflow − outflow for arc flows that respect all capacities. Then every
/// cut of the network costs at least Σ max(terminal, 0) − Σ max(e, 0) (weak duality), and a cut that costs
/// exactly this much is minimum. So the source is asked for everything anew, and it is checked that
/// capacities are respected, that the excesses are what the arc flows make them, and that this bound, the
/// capacity of the labelled cut and `cut.flow` are one number. It does not check which of several minimum
/// cuts came back. Takes 8 bytes a slot. Throws InvalidArgument when the source has other nodes or edges than
/// the network.
CutReport verify(const NetworkSource& source, const Network& network, const MinCut& cut);

}  // namespace vdbfuse
