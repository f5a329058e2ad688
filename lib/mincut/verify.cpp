// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/verify.h"

#include <algorithm>
#include <atomic>

#include "lattice_edges.h"
#include "listed_edges.h"
#include "state.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using mincut::State;

/// Sums up what tiles and edges say, from any thread: integer sums do not depend on the order.
class Auditor {
 public:
  Auditor(const State& state, const MinCut& cut)
      : state_(state), cut_(cut), surplus_(std::size_t{state.tileCount()} * lattice::kSlots, 0) {}

  void addTerminal(std::uint32_t node, std::int64_t terminal) {
    addSurplus(node, terminal);
    flow_ += std::max<std::int64_t>(terminal, 0) - std::max<std::int64_t>(state_.excess[node], 0);
    capacity_ += isSource(node) ? std::max<std::int64_t>(-terminal, 0) : std::max<std::int64_t>(terminal, 0);
  }

  void addEdge(const NetworkEdge& edge, std::int64_t residual, std::int64_t reverse_residual) {
    const std::int64_t flow = edge.capacity - residual;
    if (flow != reverse_residual - edge.reverse_capacity) {
      ++overfull_;
      lower(first_overfull_, edge.from);
    }
    addSurplus(edge.from, -flow);
    addSurplus(edge.to, flow);
    if (isSource(edge.from) && !isSource(edge.to)) capacity_ += edge.capacity;
    if (!isSource(edge.from) && isSource(edge.to)) capacity_ += edge.reverse_capacity;
  }

  CutReport report() const {
    CutReport report;
    report.cut_capacity = capacity_;
    report.flow = flow_;
    report.overfull_edges = overfull_;
    addProblem(report, overfull_,
               "edges whose residuals do not add up to their capacities, the first at node ",
               first_overfull_);
    std::size_t first = 0;
    for (std::size_t node = surplus_.size(); node-- > 0;) {
      if (surplus_[node] == state_.excess[node]) continue;
      ++report.unbalanced_nodes;
      first = node;
    }
    addProblem(report, report.unbalanced_nodes,
               "nodes whose excess is not terminal + inflow - outflow, the first is ", first);
    return report;
  }

 private:
  bool isSource(std::uint32_t node) const { return cut_.side(node) == CutSide::Source; }
  void addSurplus(std::uint32_t node, std::int64_t amount) {
    std::atomic_ref(surplus_[node]).fetch_add(amount, std::memory_order_relaxed);
  }
  static void lower(std::atomic<std::uint64_t>& least, std::uint64_t value) {
    std::uint64_t now = least;
    while (value < now && !least.compare_exchange_weak(now, value)) {
    }
  }
  static void addProblem(CutReport& report, std::uint64_t count, const std::string& what,
                         std::uint64_t first) {
    if (count > 0) report.problems.push_back(std::to_string(count) + " " + what + std::to_string(first));
  }

  const State& state_;
  const MinCut& cut_;
  std::vector<std::int64_t> surplus_;
  std::atomic<std::int64_t> capacity_ = 0, flow_ = 0;
  std::atomic<std::uint64_t> overfull_ = 0, first_overfull_ = ~std::uint64_t{0};
};

void auditTile(const NetworkSource& source, const State& state, std::uint32_t tile, Auditor& auditor) {
  TileCapacities values;
  mincut::askForTile(source, state, tile, values);
  for (std::uint64_t nodes = state.tiles[tile].nodes; nodes != 0; nodes &= nodes - 1) {
    const auto slot = static_cast<std::uint32_t>(std::countr_zero(nodes));
    auditor.addTerminal(tile * lattice::kSlots + slot, values.terminal[slot]);
  }
  mincut::forEachLatticeEdge(
      state, tile, values,
      [&](std::uint32_t from, std::uint32_t to, int d, std::int32_t capacity, std::int32_t reverse_capacity) {
        auditor.addEdge({from, to, capacity, reverse_capacity}, state.residual[State::latticeArc(from, d)],
                        state.residual[State::latticeArc(to, lattice::opposite(d))]);
      });
}

void checkValues(const MinCut& cut, CutReport& report) {
  if (cut.flow != report.flow) {
    report.problems.push_back("the flow is stated as " + std::to_string(cut.flow) + ", but the arcs carry " +
                              std::to_string(report.flow));
  }
  if (report.cut_capacity != report.flow) {
    report.problems.push_back("the cut has a capacity of " + std::to_string(report.cut_capacity) +
                              ", but the flow is " + std::to_string(report.flow));
  }
}

}  // namespace

CutReport verify(const NetworkSource& source, const Network& network, const MinCut& cut) {
  const State& state = network.state();
  if (source.tiles.size() != state.tileCount())
    throw InvalidArgument("source", "has " + std::to_string(source.tiles.size()) +
                                        " tiles, but the network has " + std::to_string(state.tileCount()));
  if (cut.source.size() != state.tileCount()) {
    CutReport report;
    report.problems.push_back("the cut has labels for " + std::to_string(cut.source.size()) +
                              " tiles, expected " + std::to_string(state.tileCount()));
    return report;
  }
  Auditor auditor(state, cut);
  parallelFor(state.tileCount(), mincut::kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    for (auto tile = static_cast<std::uint32_t>(begin); tile < end; ++tile)
      auditTile(source, state, tile, auditor);
  });
  mincut::forEachListedEdge(state, source, [&](const NetworkEdge& edge, mincut::ArcCursor::Arcs arcs) {
    auditor.addEdge(edge, state.arc_residual[arcs.arc], state.arc_residual[arcs.mate]);
  });
  CutReport report = auditor.report();
  checkValues(cut, report);
  return report;
}

}  // namespace vdbfuse
