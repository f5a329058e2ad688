// SPDX-License-Identifier: Apache-2.0
#include "forests.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vdbfuse::mincut {
namespace {

constexpr std::uint64_t kTicksBetweenReports = 1 << 16;

}  // namespace

void LevelQueue::push(std::uint32_t node, std::int32_t level, std::vector<std::uint32_t>& links) {
  if (static_cast<std::size_t>(level) >= tops_.size()) tops_.resize(2 * level + 1, kEndOfList);
  lowest_ = size_ == 0 ? level : std::min(lowest_, level);
  highest_ = size_ == 0 ? level : std::max(highest_, level);
  links[node] = std::exchange(tops_[level], node);
  ++size_;
}

std::uint32_t LevelQueue::popLowest(std::vector<std::uint32_t>& links) {
  while (tops_[lowest_] == kEndOfList) ++lowest_;
  return pop(lowest_, links);
}

std::uint32_t LevelQueue::popHighest(std::vector<std::uint32_t>& links) {
  while (tops_[highest_] == kEndOfList) --highest_;
  return pop(highest_, links);
}

std::uint32_t LevelQueue::pop(std::int32_t level, std::vector<std::uint32_t>& links) {
  const std::uint32_t node = tops_[level];
  tops_[level] = std::exchange(links[node], kNotQueued);
  --size_;
  return node;
}

Forests::Forests(const Network& network, const Progress& progress)
    : network_(network),
      progress_(progress),
      residual_(network.arcCount()),
      nodes_(network.nodeCount()),
      links_(network.nodeCount(), kNotQueued) {
  for (std::uint32_t arc = 0; arc < network.arcCount(); ++arc) residual_[arc] = network.capacity(arc);
  for (std::uint32_t node = 0; node < network.nodeCount(); ++node) {
    nodes_[node] = {network.terminal(node), kRoot, 0};
    if (nodes_[node].excess != 0) ++in_forests_;
    if (nodes_[node].excess > 0) place<Tree::Source>(node, kRoot, 1);
    if (nodes_[node].excess < 0) place<Tree::Sink>(node, kRoot, 1);
  }
}

void Forests::maximiseFlow() {
  const std::vector<std::uint32_t>& source = frontier<Tree::Source>().nodes;
  const std::vector<std::uint32_t>& sink = frontier<Tree::Sink>().nodes;
  while (!source.empty() && !sink.empty()) {
    if (source.size() <= sink.size()) {
      growLevel<Tree::Source>();
    } else {
      growLevel<Tree::Sink>();
    }
  }
}

template <Tree T>
void Forests::exhaust() {
  while (!frontier<T>().nodes.empty()) growLevel<T>();
}

/// Gives the node its place in the forest; on the deepest levels that makes it one to scan.
template <Tree T>
void Forests::place(std::uint32_t node, std::uint32_t parent, std::int32_t depth) {
  nodes_[node].parent = parent;
  nodes_[node].level = levelAt<T>(depth);
  Frontier& deepest = frontier<T>();
  if (depth == deepest.level) {
    deepest.nodes.push_back(node);
  } else if (deepest.growing && depth == deepest.level - 1) {
    deepest.scanning.push_back(node);
  }
}

template <Tree T>
void Forests::growLevel() {
  ++statistics_.passes;
  Frontier& deepest = frontier<T>();
  std::swap(deepest.scanning, deepest.nodes);
  deepest.nodes.clear();
  deepest.growing = true;
  ++deepest.level;
  for (std::size_t i = 0; i < deepest.scanning.size(); ++i) {
    const std::uint32_t node = deepest.scanning[i];
    if (!isIn<T>(nodes_[node]) || depth<T>(nodes_[node]) != deepest.level - 1) continue;
    scan<T>(node);
    drain();
  }
  deepest.growing = false;
}

template <Tree T>
void Forests::scan(std::uint32_t node) {
  tick();
  ++statistics_.scans;
  const std::int32_t next_depth = frontier<T>().level;
  const std::uint32_t end = network_.firstArc(node + 1);
  for (std::uint32_t arc = network_.firstArc(node); arc < end; ++arc) {
    const std::uint32_t neighbour = network_.head(arc);
    if (isIn<T>(nodes_[neighbour]) || room<opposite(T)>(arc) == 0) continue;
    if (nodes_[neighbour].level != 0) {
      if (T == Tree::Source) fillBridge(arc, node);
      if (T == Tree::Sink) fillBridge(network_.mate(arc), neighbour);
      if (room<opposite(T)>(arc) == 0) continue;
    }
    if (!isIn<T>(nodes_[node]) || depth<T>(nodes_[node]) != next_depth - 1) return;
    ++in_forests_;
    place<T>(neighbour, network_.mate(arc), next_depth);
  }
}

/// Fills the bridge, or empties the source forest's supply for it: then its tail leaves the source forest, or
/// sinks to a level that is yet to be scanned.
void Forests::fillBridge(std::uint32_t arc, std::uint32_t tail) {
  ++statistics_.bridges;
  while (residual_[arc] > 0 && isIn<Tree::Source>(nodes_[tail])) {
    const auto amount = static_cast<std::uint32_t>(std::min<std::int64_t>(residual_[arc], supply(tail)));
    pull(tail, amount);
    push(arc, amount);
    arrive(network_.head(arc), amount);
    while (!orphans_.empty()) adopt<Tree::Source>(orphans_.popLowest(links_));
  }
}

/// What the tree path from its root can bring to the node.
std::int64_t Forests::supply(std::uint32_t node) const {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  while (nodes_[node].parent != kRoot) {
    least = std::min<std::int64_t>(least, room<Tree::Source>(nodes_[node].parent));
    node = network_.head(nodes_[node].parent);
  }
  return std::min(least, nodes_[node].excess);
}

void Forests::pull(std::uint32_t node, std::uint32_t amount) {
  while (nodes_[node].parent != kRoot) {
    ++statistics_.pushes;
    const std::uint32_t arc = network_.mate(nodes_[node].parent);
    push(arc, amount);
    if (residual_[arc] == 0) orphan<Tree::Source>(node);
    node = network_.head(nodes_[node].parent);
  }
  nodes_[node].excess -= amount;
  if (nodes_[node].excess == 0) orphan<Tree::Source>(node);
}

void Forests::push(std::uint32_t arc, std::uint32_t amount) {
  residual_[arc] -= amount;
  residual_[network_.mate(arc)] += amount;
}

/// A child pushes on all it has; a root is used up when it has no deficit left.
bool Forests::mustPush(const Node& node) { return node.parent == kRoot ? node.excess >= 0 : node.excess > 0; }

void Forests::arrive(std::uint32_t node, std::uint32_t amount) {
  Node& state = nodes_[node];
  const bool waits_already = mustPush(state);
  state.excess += amount;
  if (!waits_already && mustPush(state)) loads_.push(node, depth<Tree::Sink>(state), links_);
}

/// Pushes all excess in the sink forest rootwards and mends the forest, until no node of it has an excess.
void Forests::drain() {
  while (!loads_.empty()) {
    while (!loads_.empty()) pushRootwards(loads_.popHighest(links_));
    while (!orphans_.empty()) adopt<Tree::Sink>(orphans_.popLowest(links_));
    for (const std::uint32_t node : loaded_orphans_) {
      const Node& state = nodes_[node];
      if (isIn<Tree::Sink>(state) && !isQueued(node)) loads_.push(node, depth<Tree::Sink>(state), links_);
    }
    loaded_orphans_.clear();
  }
}

void Forests::pushRootwards(std::uint32_t node) {
  Node& state = nodes_[node];
  if (state.parent == kRoot) return orphan<Tree::Sink>(node);
  ++statistics_.pushes;
  const auto amount =
      static_cast<std::uint32_t>(std::min<std::int64_t>(state.excess, residual_[state.parent]));
  push(state.parent, amount);
  state.excess -= amount;
  arrive(network_.head(state.parent), amount);
  if (residual_[state.parent] == 0) orphan<Tree::Sink>(node);
}

template <Tree T>
void Forests::orphan(std::uint32_t node) {
  orphans_.push(node, depth<T>(nodes_[node]), links_);
}

/// Finds the orphan another parent. All shallower nodes have theirs, so that its level can only stay or sink;
/// if it sinks, its children are no longer one level below it and must choose again.
template <Tree T>
void Forests::adopt(std::uint32_t node) {
  tick();
  const std::uint32_t arc = nearestParent<T>(node);
  if (arc == kRoot) return release<T>(node);
  ++statistics_.adoptions;
  const std::int32_t new_depth = depth<T>(nodes_[network_.head(arc)]) + 1;
  if (new_depth == depth<T>(nodes_[node])) {
    nodes_[node].parent = arc;
  } else {
    orphanChildren<T>(node);
    place<T>(node, arc, new_depth);
  }
  if (T == Tree::Sink && nodes_[node].excess > 0) loaded_orphans_.push_back(node);
}

/// The arc to the shallowest node with room that is above the forest's deepest level, or kRoot. The search
/// starts after the old parent, so that a node with many arcs does not look at the same filled ones each
/// time.
template <Tree T>
std::uint32_t Forests::nearestParent(std::uint32_t node) const {
  const std::int32_t wanted = depth<T>(nodes_[node]) - 1;
  const std::uint32_t begin = network_.firstArc(node);
  const std::uint32_t end = network_.firstArc(node + 1);
  const std::uint32_t old = nodes_[node].parent;
  std::uint32_t arc = old == kRoot ? end : old + 1;
  std::uint32_t nearest = kRoot;
  std::int32_t least = frontiers_[static_cast<std::size_t>(T)].level;
  for (std::uint32_t i = begin; i < end; ++i, ++arc) {
    if (arc >= end) arc = begin;
    const Node& other = nodes_[network_.head(arc)];
    if (!isIn<T>(other) || depth<T>(other) >= least || room<T>(arc) == 0) continue;
    least = depth<T>(other);
    nearest = arc;
    if (least == wanted) break;
  }
  return nearest;
}

template <Tree T>
void Forests::orphanChildren(std::uint32_t node) {
  const std::uint32_t end = network_.firstArc(node + 1);
  for (std::uint32_t arc = network_.firstArc(node); arc < end; ++arc) {
    const std::uint32_t child = network_.head(arc);
    const Node& state = nodes_[child];
    if (isIn<T>(state) && state.parent == network_.mate(arc) && !isQueued(child)) orphan<T>(child);
  }
}

/// The node leaves the forest. With a load it becomes a root of the other one, on its deepest level: nothing
/// is known of what surrounds it there.
template <Tree T>
void Forests::release(std::uint32_t node) {
  ++statistics_.releases;
  orphanChildren<T>(node);
  if (nodes_[node].excess > 0) {
    place<Tree::Source>(node, kRoot, frontier<Tree::Source>().level);
  } else {
    --in_forests_;
    nodes_[node].level = 0;
  }
}

void Forests::tick() {
  if (++ticks_ % kTicksBetweenReports != 0) return;
  progress_.report("minimum cut", static_cast<double>(in_forests_) / static_cast<double>(nodes_.size()));
}

MinCut Forests::takeResult(CutTies ties) {
  MinCut cut;
  cut.statistics = statistics_;
  cut.residual = std::move(residual_);
  cut.sides.reserve(nodes_.size());
  cut.excess.reserve(nodes_.size());
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    const Node& state = nodes_[node];
    const bool source = ties == CutTies::SmallestSource ? state.level > 0 : state.level >= 0;
    cut.sides.push_back(source ? CutSide::Source : CutSide::Sink);
    cut.excess.push_back(state.excess);
    cut.flow += std::max<std::int64_t>(network_.terminal(node), 0) - std::max<std::int64_t>(state.excess, 0);
  }
  return cut;
}

template void Forests::exhaust<Tree::Source>();
template void Forests::exhaust<Tree::Sink>();

}  // namespace vdbfuse::mincut
