// SPDX-License-Identifier: Apache-2.0
#include "listed_edges.h"

#include <algorithm>

#include "vdbfuse/base/errors.h"

namespace vdbfuse::mincut {
namespace {

[[noreturn]] void refuse(std::uint64_t edge, const std::string& what_is_wrong) {
  throw InvalidArgument("edges", "edge " + std::to_string(edge) + " " + what_is_wrong);
}

bool isNode(std::uint32_t node, const State& state) {
  return tileOf(node) < state.tileCount() && (state.tiles[tileOf(node)].nodes & bitOf(node)) != 0;
}

}  // namespace

void checkEdge(const NetworkEdge& edge, std::uint64_t index, const State& state) {
  for (const std::uint32_t node : {edge.from, edge.to}) {
    if (isNode(node, state)) continue;
    refuse(index, "joins nodes " + std::to_string(edge.from) + " and " + std::to_string(edge.to) +
                      ", but there is no node " + std::to_string(node));
  }
  if (edge.from == edge.to) refuse(index, "joins node " + std::to_string(edge.from) + " to itself");
  const std::int32_t smaller = std::min(edge.capacity, edge.reverse_capacity);
  if (smaller < 0) refuse(index, "has the negative capacity " + std::to_string(smaller));
}

void refuseOtherEdges() {
  throw InvalidArgument("edges", "not the edges that were handed over the time before");
}

ArcCursor::ArcCursor(const State& state)
    : state_(state), ends_(state.row_starts.begin() + 1, state.row_starts.end()) {}

ArcCursor::Arcs ArcCursor::next(const NetworkEdge& edge) {
  checkEdge(edge, edges_++, state_);
  const std::uint32_t arc = take(edge.from);
  return {arc, take(edge.to)};
}

std::uint32_t ArcCursor::take(std::uint32_t node) {
  if (!state_.isJoined(node)) refuseOtherEdges();
  const std::uint32_t row = state_.row(node);
  if (ends_[row] == state_.row_starts[row]) refuseOtherEdges();
  return --ends_[row];
}

void ArcCursor::finish() const {
  if (2 * edges_ != state_.heads.size()) refuseOtherEdges();
}

void forEachListedEdge(const State& state, const NetworkSource& source,
                       const std::function<void(const NetworkEdge&, ArcCursor::Arcs)>& visit) {
  ArcCursor cursor(state);
  if (source.edges) {
    source.edges([&](std::span<const NetworkEdge> batch) {
      for (const NetworkEdge& edge : batch) {
        const ArcCursor::Arcs arcs = cursor.next(edge);
        if (state.heads[arcs.arc] != edge.to || state.heads[arcs.mate] != edge.from) refuseOtherEdges();
        visit(edge, arcs);
      }
    });
  }
  cursor.finish();
}

}  // namespace vdbfuse::mincut
