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

/// What a part of the nodes and edges adds up to.
struct Sums {
  std::int64_t capacity = 0, flow = 0;
  std::uint64_t overfull = 0, first_overfull = ~std::uint64_t{0};

  void add(const Sums& other) {
    capacity += other.capacity;
    flow += other.flow;
    overfull += other.overfull;
    first_overfull = std::min(first_overfull, other.first_overfull);
  }
};

/// Asks for all tiles and edges anew, on several threads: integer sums do not depend on the order.
class Auditor {
 public:
  Auditor(const NetworkSource& source, const State& state, const MinCut& cut)
      : source_(source),
        state_(state),
        cut_(cut),
        surplus_(std::size_t{state.tileCount()} * lattice::kSlots, 0) {}

  void run() {
    std::vector<Sums> parts(chunkCount(state_.tileCount(), mincut::kTilesPerTask));
    parallelFor(state_.tileCount(), mincut::kTilesPerTask, [&](std::size_t begin, std::size_t end) {
      for (auto tile = static_cast<std::uint32_t>(begin); tile < end; ++tile)
        addTile(tile, parts[begin / mincut::kTilesPerTask]);
    });
    for (const Sums& part : parts) sums_.add(part);
    mincut::forEachListedEdge(state_, source_, [&](const NetworkEdge& edge, mincut::ArcCursor::Arcs arcs) {
      addEdge(edge, state_.arc_residual[arcs.arc], state_.arc_residual[arcs.mate], sums_);
    });
  }

  CutReport report() const {
    CutReport report;
    report.cut_capacity = sums_.capacity;
    report.flow = sums_.flow;
    report.overfull_edges = sums_.overfull;
    addProblem(report, sums_.overfull,
               "edges whose residuals do not add up to their capacities, the first at node ",
               sums_.first_overfull);
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
  void addTile(std::uint32_t tile, Sums& sums) {
    TileCapacities values;
    mincut::askForTile(source_, state_, tile, values);
    for (std::uint64_t nodes = state_.tiles[tile].nodes; nodes != 0; nodes &= nodes - 1) {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(nodes));
      addTerminal(tile * lattice::kSlots + slot, values.terminal[slot], sums);
    }
    mincut::forEachLatticeEdge(state_, tile, values,
                               [&](std::uint32_t from, std::uint32_t to, int d, std::int32_t capacity,
                                   std::int32_t reverse_capacity) {
                                 const int back = lattice::opposite(d);
                                 addEdge({from, to, capacity, reverse_capacity},
                                         state_.residual[State::latticeArc(from, d)],
                                         state_.residual[State::latticeArc(to, back)], sums);
                               });
  }

  void addTerminal(std::uint32_t node, std::int64_t terminal, Sums& sums) {
    addSurplus(node, terminal);
    sums.flow += std::max<std::int64_t>(terminal, 0) - std::max<std::int64_t>(state_.excess[node], 0);
    sums.capacity += std::max<std::int64_t>(isSource(node) ? -terminal : terminal, 0);
  }

  void addEdge(const NetworkEdge& edge, std::int64_t residual, std::int64_t reverse_residual, Sums& sums) {
    const std::int64_t flow = edge.capacity - residual;
    if (flow != reverse_residual - edge.reverse_capacity) {
      ++sums.overfull;
      sums.first_overfull = std::min<std::uint64_t>(sums.first_overfull, edge.from);
    }
    addSurplus(edge.from, -flow);
    addSurplus(edge.to, flow);
    if (isSource(edge.from) && !isSource(edge.to)) sums.capacity += edge.capacity;
    if (!isSource(edge.from) && isSource(edge.to)) sums.capacity += edge.reverse_capacity;
  }

  bool isSource(std::uint32_t node) const { return cut_.side(node) == CutSide::Source; }
  void addSurplus(std::uint32_t node, std::int64_t amount) {
    if (amount != 0) std::atomic_ref(surplus_[node]).fetch_add(amount, std::memory_order_relaxed);
  }
  static void addProblem(CutReport& report, std::uint64_t count, const std::string& what,
                         std::uint64_t first) {
    if (count > 0) report.problems.push_back(std::to_string(count) + " " + what + std::to_string(first));
  }

  const NetworkSource& source_;
  const State& state_;
  const MinCut& cut_;
  std::vector<std::int64_t> surplus_;  ///< terminal + inflow − outflow, by node
  Sums sums_;
};

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
  Auditor auditor(source, state, cut);
  auditor.run();
  CutReport report = auditor.report();
  checkValues(cut, report);
  return report;
}

}  // namespace vdbfuse
