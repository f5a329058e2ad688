// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/verify.h"

#include <algorithm>

namespace vdbfuse {
namespace {

std::string counted(std::uint64_t count, const std::string& what, std::uint64_t first) {
  return std::to_string(count) + " " + what + ", the first is " + std::to_string(first);
}

bool checkLengths(const Network& network, const MinCut& cut, CutReport& report) {
  const auto check = [&](std::size_t length, std::size_t expected, const std::string& name) {
    if (length == expected) return;
    report.problems.push_back(name + " has " + std::to_string(length) + " values, expected " +
                              std::to_string(expected));
  };
  check(cut.sides.size(), network.nodeCount(), "sides");
  check(cut.excess.size(), network.nodeCount(), "excess");
  check(cut.residual.size(), network.arcCount(), "residual");
  return report.problems.empty();
}

/// What arc carries, negative where its mate does.
std::int64_t flowOn(const Network& network, const MinCut& cut, std::uint32_t arc) {
  return std::int64_t{network.capacity(arc)} - std::int64_t{cut.residual[arc]};
}

void checkCapacities(const Network& network, const MinCut& cut, CutReport& report) {
  std::uint32_t first = 0;
  for (std::uint32_t arc = 0; arc < network.arcCount(); ++arc) {
    const std::uint32_t mate = network.mate(arc);
    if (arc > mate || flowOn(network, cut, arc) == -flowOn(network, cut, mate)) continue;
    if (report.overfull_edges++ == 0) first = arc;
  }
  if (report.overfull_edges == 0) return;
  report.problems.push_back(
      counted(report.overfull_edges, "edges whose residuals do not add up to their capacities", first));
}

void checkConservation(const Network& network, const MinCut& cut, CutReport& report) {
  std::uint32_t first = 0;
  for (std::uint32_t node = 0; node < network.nodeCount(); ++node) {
    std::int64_t excess = network.terminal(node);
    for (std::uint32_t arc = network.firstArc(node); arc < network.firstArc(node + 1); ++arc) {
      excess -= flowOn(network, cut, arc);
    }
    report.flow += std::max<std::int64_t>(network.terminal(node), 0) - std::max<std::int64_t>(excess, 0);
    if (excess != cut.excess[node] && report.unbalanced_nodes++ == 0) first = node;
  }
  if (report.unbalanced_nodes == 0) return;
  report.problems.push_back(
      counted(report.unbalanced_nodes, "nodes whose excess is not terminal + inflow - outflow", first));
}

std::int64_t cutCapacity(const Network& network, const std::vector<CutSide>& sides) {
  std::int64_t capacity = 0;
  for (std::uint32_t node = 0; node < network.nodeCount(); ++node) {
    const std::int64_t terminal = network.terminal(node);
    if (sides[node] == CutSide::Sink) {
      capacity += std::max<std::int64_t>(terminal, 0);
      continue;
    }
    capacity += std::max<std::int64_t>(-terminal, 0);
    for (std::uint32_t arc = network.firstArc(node); arc < network.firstArc(node + 1); ++arc) {
      if (sides[network.head(arc)] == CutSide::Sink) capacity += network.capacity(arc);
    }
  }
  return capacity;
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

CutReport verify(const Network& network, const MinCut& cut) {
  CutReport report;
  if (!checkLengths(network, cut, report)) return report;
  checkCapacities(network, cut, report);
  checkConservation(network, cut, report);
  report.cut_capacity = cutCapacity(network, cut.sides);
  checkValues(cut, report);
  return report;
}

}  // namespace vdbfuse
