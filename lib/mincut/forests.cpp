// SPDX-License-Identifier: Apache-2.0
#include "forests.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vdbfuse::mincut {
namespace {

constexpr std::uint64_t kTicksBetweenReports = 1 << 16;

template <typename T>
std::size_t bytesOf(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

}  // namespace

Forests::Forests(const Network& network, Orientation orientation, const Progress& progress)
    : network_(network),
      orientation_(orientation),
      progress_(progress),
      residual_(network.arcCount()),
      excess_(network.nodeCount()),
      parent_(network.nodeCount(), kRoot),
      level_(network.nodeCount(), 0) {
  const bool reversed = orientation == Orientation::Reversed;
  for (std::uint32_t arc = 0; arc < network.arcCount(); ++arc) {
    residual_[arc] = network.capacity(reversed ? network.mate(arc) : arc);
  }
  for (std::uint32_t node = 0; node < network.nodeCount(); ++node) {
    excess_[node] = reversed ? -network.terminal(node) : network.terminal(node);
  }
  settleNeighbours();
  for (std::uint32_t node = 0; node < network.nodeCount(); ++node) {
    if (excess_[node] > 0) place<Tree::Source>(node, kRoot, 1);
    if (excess_[node] < 0) place<Tree::Sink>(node, kRoot, 1);
    if (excess_[node] != 0) ++in_forests_;
  }
}

/// Excesses next to deficits need no forest to find each other: one sweep in memory order.
void Forests::settleNeighbours() {
  for (std::uint32_t node = 0; node < network_.nodeCount(); ++node) {
    const std::uint32_t end = network_.firstArc(node + 1);
    for (std::uint32_t arc = network_.firstArc(node); arc < end && excess_[node] > 0; ++arc) {
      const std::uint32_t neighbour = network_.head(arc);
      if (excess_[neighbour] >= 0) continue;
      const std::int64_t wanted = std::min(excess_[node], -excess_[neighbour]);
      const auto amount = static_cast<std::uint32_t>(std::min<std::int64_t>(wanted, residual_[arc]));
      push(arc, amount);
      excess_[node] -= amount;
      excess_[neighbour] += amount;
    }
  }
}

void Forests::maximiseFlow() {
  while (!frontier<Tree::Source>().nodes.empty() && !frontier<Tree::Sink>().nodes.empty()) {
    if (reluctance<Tree::Source>() <= reluctance<Tree::Sink>()) {
      growLevel<Tree::Source>();
    } else {
      growLevel<Tree::Sink>();
    }
  }
}

/// Forests of equal depth meet halfway and on short paths, and little is cut off from its root when an arc of
/// such a path is filled; a wide shallow forest may wait a little while a narrow one grows. (Growing always
/// the narrower one took up to 35 times the adoptions where evidence is sparse; strict turns scan every root
/// in vain where it is dense.)
template <Tree T>
double Forests::reluctance() const {
  const Frontier& deepest = frontiers_[static_cast<std::size_t>(T)];
  const double level = deepest.level;
  return level * level * level * level * static_cast<double>(deepest.nodes.size());
}

/// Starts from the nodes in neither forest, which are few, and not from the frontier, which can be
/// everything.
template <Tree T>
void Forests::exhaust() {
  for (std::uint32_t node = 0; node < network_.nodeCount(); ++node) {
    if (level_[node] == 0 && reaches<T>(node)) flood<T>(node);
  }
}

template <Tree T>
bool Forests::reaches(std::uint32_t node) const {
  const std::uint32_t end = network_.firstArc(node + 1);
  for (std::uint32_t arc = network_.firstArc(node); arc < end; ++arc) {
    if (isIn<T>(network_.head(arc)) && room<T>(arc) > 0) return true;
  }
  return false;
}

/// Labels the node, and all nodes in neither forest that it connects, as in this forest.
template <Tree T>
void Forests::flood(std::uint32_t node) {
  level_[node] = levelAt<T>(1);
  std::vector<std::uint32_t> open = {node};
  while (!open.empty()) {
    const std::uint32_t last = open.back();
    open.pop_back();
    const std::uint32_t end = network_.firstArc(last + 1);
    for (std::uint32_t arc = network_.firstArc(last); arc < end; ++arc) {
      const std::uint32_t neighbour = network_.head(arc);
      if (level_[neighbour] != 0 || room<opposite(T)>(arc) == 0) continue;
      level_[neighbour] = levelAt<T>(1);
      open.push_back(neighbour);
    }
  }
}

/// Gives the node its place in the forest; on the deepest levels that makes it one to scan.
template <Tree T>
void Forests::place(std::uint32_t node, std::uint32_t parent, std::int32_t depth) {
  parent_[node] = parent;
  level_[node] = levelAt<T>(depth);
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
    if (!isIn<T>(node) || depth<T>(node) != deepest.level - 1) continue;
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
    if (isIn<T>(neighbour) || room<opposite(T)>(arc) == 0) continue;
    if (level_[neighbour] != 0) {
      if (T == Tree::Source) fillBridge(arc, node);
      if (T == Tree::Sink) fillBridge(network_.mate(arc), neighbour);
      if (room<opposite(T)>(arc) == 0) continue;
    }
    if (!isIn<T>(node) || depth<T>(node) != next_depth - 1) return;
    ++in_forests_;
    place<T>(neighbour, network_.mate(arc), next_depth);
  }
}

/// Fills the bridge, or empties the source forest's supply for it: then its tail leaves the source forest, or
/// sinks to a level that is yet to be scanned.
void Forests::fillBridge(std::uint32_t arc, std::uint32_t tail) {
  ++statistics_.bridges;
  while (residual_[arc] > 0 && isIn<Tree::Source>(tail)) {
    const auto amount = static_cast<std::uint32_t>(std::min<std::int64_t>(residual_[arc], supply(tail)));
    pull(tail, amount);
    push(arc, amount);
    arrive(network_.head(arc), amount);
    mend<Tree::Source>();
  }
}

/// What the tree path from its root can bring to the node.
std::int64_t Forests::supply(std::uint32_t node) const {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  while (parent_[node] != kRoot) {
    least = std::min<std::int64_t>(least, room<Tree::Source>(parent_[node]));
    node = network_.head(parent_[node]);
  }
  return std::min(least, excess_[node]);
}

void Forests::pull(std::uint32_t node, std::uint32_t amount) {
  while (parent_[node] != kRoot) {
    ++statistics_.pushes;
    const std::uint32_t parent = network_.head(parent_[node]);
    const std::uint32_t arc = network_.mate(parent_[node]);
    push(arc, amount);
    if (residual_[arc] == 0) orphan<Tree::Source>(node);
    node = parent;
  }
  excess_[node] -= amount;
  if (excess_[node] == 0) orphan<Tree::Source>(node);
}

void Forests::push(std::uint32_t arc, std::uint32_t amount) {
  residual_[arc] -= amount;
  residual_[network_.mate(arc)] += amount;
}

/// A child pushes on all it has; a root is used up when it has no deficit left.
bool Forests::mustPush(std::uint32_t node) const {
  return parent_[node] == kRoot ? excess_[node] >= 0 : excess_[node] > 0;
}

void Forests::arrive(std::uint32_t node, std::uint32_t amount) {
  const bool waits_already = mustPush(node);
  excess_[node] += amount;
  if (!waits_already && mustPush(node)) loads_.push({node, kNoArc}, depth<Tree::Sink>(node));
}

/// Pushes all excess in the sink forest rootwards and mends the forest, until no node of it has an excess.
void Forests::drain() {
  while (!loads_.empty()) {
    while (!loads_.empty()) pushRootwards(loads_.popHighest().node);
    mend<Tree::Sink>();
    for (const std::uint32_t node : loaded_) {
      if (isIn<Tree::Sink>(node)) loads_.push({node, kNoArc}, depth<Tree::Sink>(node));
    }
    loaded_.clear();
  }
}

void Forests::pushRootwards(std::uint32_t node) {
  if (parent_[node] == kOrphan || !mustPush(node)) return;  // it waited twice
  if (parent_[node] == kRoot) return orphan<Tree::Sink>(node);
  ++statistics_.pushes;
  const auto amount =
      static_cast<std::uint32_t>(std::min<std::int64_t>(excess_[node], residual_[parent_[node]]));
  push(parent_[node], amount);
  excess_[node] -= amount;
  arrive(network_.head(parent_[node]), amount);
  if (residual_[parent_[node]] == 0) orphan<Tree::Sink>(node);
}

template <Tree T>
void Forests::orphan(std::uint32_t node) {
  if (T == Tree::Sink && excess_[node] > 0) loaded_.push_back(node);
  orphans_.push({node, std::exchange(parent_[node], kOrphan)}, depth<T>(node));
}

/// Gives every orphan the nearest parent there is, and levels that are exact again, at a cost that depends on
/// the number of nodes that cannot keep their level and on nothing else. First, from the root downwards, a
/// node keeps its level if another parent allows it and is detached if not, which makes orphans of its
/// children. Then the detached nodes join again in order of their new levels, or leave the forest. (Deciding
/// node by node would let the nodes of a cut-off subtree adopt each other and sink one level at a time.)
template <Tree T>
void Forests::mend() {
  while (!orphans_.empty()) {
    const LevelQueue::Item orphan = orphans_.popLowest();
    keepOrDetach<T>(orphan.node, orphan.arc);
  }
  for (const std::uint32_t node : detached_) {
    const std::uint32_t arc = nearestParent<T>(node);
    if (arc != kNoArc) orphans_.push({node, arc}, depth<T>(network_.head(arc)) + 1);
  }
  while (!orphans_.empty()) {
    const LevelQueue::Item orphan = orphans_.popLowest();
    if (level_[orphan.node] == 0) reattach<T>(orphan.node, orphan.arc, orphans_.level());
  }
  for (const std::uint32_t node : detached_) {
    if (level_[node] == 0) release<T>(node);
  }
  detached_.clear();
}

template <Tree T>
void Forests::keepOrDetach(std::uint32_t node, std::uint32_t old_parent) {
  tick();
  const std::uint32_t arc = parentAt<T>(depth<T>(node) - 1, node, old_parent);
  if (arc != kNoArc) {
    ++statistics_.adoptions;
    parent_[node] = arc;
    return;
  }
  orphanChildren<T>(node);
  level_[node] = 0;
  detached_.push_back(node);
}

/// An arc with room to a node at the wanted depth, or kNoArc. The search starts after the old parent, so that
/// a node with many arcs does not look at the same filled ones each time.
template <Tree T>
std::uint32_t Forests::parentAt(std::int32_t wanted, std::uint32_t node, std::uint32_t old_parent) const {
  if (wanted == 0) return kNoArc;
  const std::uint32_t begin = network_.firstArc(node);
  const std::uint32_t end = network_.firstArc(node + 1);
  std::uint32_t arc = old_parent == kRoot ? begin : old_parent;
  for (std::uint32_t i = begin; i < end; ++i) {
    if (++arc >= end) arc = begin;
    if (level_[network_.head(arc)] == levelAt<T>(wanted) && room<T>(arc) > 0) return arc;
  }
  return kNoArc;
}

/// The arc with room to the shallowest node above the forest's deepest level, or kNoArc.
template <Tree T>
std::uint32_t Forests::nearestParent(std::uint32_t node) const {
  std::uint32_t nearest = kNoArc;
  std::int32_t least = frontiers_[static_cast<std::size_t>(T)].level;
  const std::uint32_t end = network_.firstArc(node + 1);
  for (std::uint32_t arc = network_.firstArc(node); arc < end; ++arc) {
    if (!isIn<T>(network_.head(arc)) || depth<T>(network_.head(arc)) >= least || room<T>(arc) == 0) continue;
    least = depth<T>(network_.head(arc));
    nearest = arc;
  }
  return nearest;
}

template <Tree T>
void Forests::orphanChildren(std::uint32_t node) {
  const std::int32_t level_of_children = levelAt<T>(depth<T>(node) + 1);
  const std::uint32_t end = network_.firstArc(node + 1);
  for (std::uint32_t arc = network_.firstArc(node); arc < end; ++arc) {
    const std::uint32_t child = network_.head(arc);
    if (level_[child] == level_of_children && parent_[child] == network_.mate(arc)) orphan<T>(child);
  }
}

/// A detached node joins at its new level and offers itself to its detached neighbours. Offers come
/// shallowest first: the first is the best.
template <Tree T>
void Forests::reattach(std::uint32_t node, std::uint32_t parent, std::int32_t depth) {
  ++statistics_.adoptions;
  place<T>(node, parent, depth);
  if (depth == frontier<T>().level) return;
  const std::uint32_t end = network_.firstArc(node + 1);
  for (std::uint32_t arc = network_.firstArc(node); arc < end; ++arc) {
    const std::uint32_t neighbour = network_.head(arc);
    if (level_[neighbour] != 0 || parent_[neighbour] != kOrphan || room<opposite(T)>(arc) == 0) continue;
    parent_[neighbour] = network_.mate(arc);
    orphans_.push({neighbour, network_.mate(arc)}, depth + 1);
  }
}

/// The node leaves the forest. If it leaves the sink forest with an excess it becomes a root of the source
/// forest, on the deepest level: nothing is known of what surrounds it there.
template <Tree T>
void Forests::release(std::uint32_t node) {
  ++statistics_.releases;
  if (excess_[node] > 0) {
    place<Tree::Source>(node, kRoot, frontier<Tree::Source>().level);
  } else {
    --in_forests_;
  }
}

void Forests::tick() {
  if (++ticks_ % kTicksBetweenReports != 0) return;
  progress_.report("minimum cut", static_cast<double>(in_forests_) / static_cast<double>(level_.size()));
}

void Forests::turnBack() {
  for (std::uint32_t arc = 0; arc < network_.arcCount(); ++arc) {
    if (arc < network_.mate(arc)) std::swap(residual_[arc], residual_[network_.mate(arc)]);
  }
  for (std::int64_t& excess : excess_) excess = -excess;
  for (std::int32_t& level : level_) level = -level;
}

std::size_t Forests::bytes() const {
  std::size_t bytes = bytesOf(residual_) + bytesOf(excess_) + bytesOf(parent_) + bytesOf(level_) +
                      bytesOf(detached_) + bytesOf(loaded_) + loads_.bytes() + orphans_.bytes();
  for (const Frontier& frontier : frontiers_) bytes += bytesOf(frontier.nodes) + bytesOf(frontier.scanning);
  return bytes;
}

MinCut Forests::takeResult(CutTies ties) {
  if (orientation_ == Orientation::Reversed) turnBack();
  MinCut cut;
  cut.statistics = statistics_;
  cut.statistics.bytes = bytes() + level_.size() * sizeof(CutSide);
  cut.sides.reserve(level_.size());
  for (std::uint32_t node = 0; node < level_.size(); ++node) {
    const bool source = ties == CutTies::SmallestSource ? level_[node] > 0 : level_[node] >= 0;
    cut.sides.push_back(source ? CutSide::Source : CutSide::Sink);
    cut.flow += std::max<std::int64_t>(network_.terminal(node), 0) - std::max<std::int64_t>(excess_[node], 0);
  }
  cut.residual = std::move(residual_);
  cut.excess = std::move(excess_);
  return cut;
}

template void Forests::exhaust<Tree::Source>();
template void Forests::exhaust<Tree::Sink>();

}  // namespace vdbfuse::mincut
