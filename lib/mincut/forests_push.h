// SPDX-License-Identifier: Apache-2.0
// Part of forests.h: load on its way.
#pragma once

#include <limits>

#include "forests.h"

namespace vdbfuse::mincut {

template <bool R>
Way Forests<R>::wayToParent(std::uint32_t node) const {
  const std::uint8_t parent = nodes_.parent[node];
  return parent == kListed ? nodes_.listed_parent[s_.row(node)] + kFirstListed : parent;
}

template <bool R>
void Forests<R>::setParent(std::uint32_t node, Way way) {
  nodes_.parent[node] = isListed(way) ? kListed : static_cast<std::uint8_t>(way);
  if (isListed(way)) nodes_.listed_parent[s_.row(node)] = way - kFirstListed;
}

/// Fills the way from a node that forest F is scanning to a node of the other forest.
template <bool R>
template <Forest F>
void Forests<R>::bridge(std::uint32_t node, Way way) {
  const std::uint32_t neighbour = head(node, way);
  if (F == Forest::Giver) {
    fillBridge(node, way, neighbour);
  } else {
    fillBridge(neighbour, back(way), node);
  }
}

/// Fills the bridge, or empties the giver's supply for it: then its tail leaves the giver's forest, or sinks
/// to a level that is yet to be scanned.
template <bool R>
void Forests<R>::fillBridge(std::uint32_t tail, Way way, std::uint32_t tip) {
  ++statistics_.bridges;
  const auto bridge = Flow::passage(tail, way, tip);
  while (*bridge.room > 0 && isIn<Forest::Giver>(tail)) {
    const auto amount = static_cast<std::uint32_t>(std::min<std::int64_t>(*bridge.room, supply(tail)));
    pull(tail, amount);
    move(bridge, amount);
    arrive(tip, amount);
    mend<Forest::Giver>();
  }
}

/// What the path from its root can bring to the node; leaves the path in path_.
template <bool R>
std::int64_t Forests<R>::supply(std::uint32_t node) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  path_.clear();
  for (Way way = wayToParent(node); way != kRoot; way = wayToParent(node)) {
    const std::uint32_t parent = head(node, way);
    path_.push_back(Flow::passage(parent, back(way), node));
    least = std::min<std::int64_t>(least, *path_.back().room);
    node = parent;
  }
  return std::min(least, load(node));
}

template <bool R>
void Forests<R>::pull(std::uint32_t node, std::uint32_t amount) {
  statistics_.pushes += path_.size();
  for (const auto& step : path_) {
    if (move(step, amount)) orphan<Forest::Giver>(step.to);
    node = step.from;
  }
  addLoad(node, -std::int64_t{amount});
  if (load(node) == 0) orphan<Forest::Giver>(node);
}

/// A child pushes on all it has; a root is used up when it wants nothing more.
template <bool R>
bool Forests<R>::mustPush(std::uint32_t node) const {
  return nodes_.parent[node] == kRoot ? load(node) >= 0 : load(node) > 0;
}

template <bool R>
void Forests<R>::arrive(std::uint32_t node, std::uint32_t amount) {
  const bool waits_already = mustPush(node);
  addLoad(node, amount);
  if (!waits_already && mustPush(node)) loads_.push({node, kNoWay}, depth<Forest::Taker>(node));
}

/// Pushes all load in the taker's forest rootwards and mends the forest, until no node of it has load.
template <bool R>
void Forests<R>::drain() {
  while (!loads_.empty()) {
    while (!loads_.empty()) pushRootwards(loads_.popHighest().node);
    mend<Forest::Taker>();
    for (const std::uint32_t node : loaded_) {
      if (isIn<Forest::Taker>(node)) loads_.push({node, kNoWay}, depth<Forest::Taker>(node));
    }
    loaded_.clear();
  }
}

template <bool R>
void Forests<R>::pushRootwards(std::uint32_t node) {
  if (!mustPush(node)) return;  // it waited twice
  const Way way = wayToParent(node);
  if (way == kRoot || way == kOrphan) return loseParent(node, way);
  ++statistics_.pushes;
  const std::uint32_t parent = head(node, way);
  const auto up = Flow::passage(node, way, parent);
  const auto amount = static_cast<std::uint32_t>(std::min<std::int64_t>(load(node), *up.room));
  const bool filled = move(up, amount);
  addLoad(node, -std::int64_t{amount});
  arrive(parent, amount);
  if (filled) loseParent(node, way);
}

template <bool R>
void Forests<R>::loseParent(std::uint32_t node, Way old) {
  if (load(node) > 0 && takeParentAtOnce(node)) {
    loads_.push({node, kNoWay}, depth<Forest::Taker>(node));
    return;
  }
  if (load(node) > 0) loaded_.push_back(node);
  if (old != kOrphan) orphan<Forest::Taker>(node);
}

/// A parent not deeper than the node itself, so that it is none of its own descendants: their levels are all
/// deeper, and where a chain of parents is broken by an orphan, load just waits there. The children of a node
/// that sinks become orphans and are seen to when the load has passed. (Mending everything behind the load
/// each time it stops detaches up to a third more nodes.)
template <bool R>
bool Forests<R>::takeParentAtOnce(std::uint32_t node) {
  const std::int32_t depth_now = depth<Forest::Taker>(node);
  const Around neighbours = around(node);
  const std::int32_t limit = std::min(depth_now + 1, frontier<Forest::Taker>().level);
  const Parent parent = nearestParent<Forest::Taker>(node, limit, neighbours);
  if (parent.way == kNoWay) return false;
  ++statistics_.adoptions;
  if (parent.depth + 1 == depth_now) {
    setParent(node, parent.way);
    return true;
  }
  orphanChildren<Forest::Taker>(node, depth_now, neighbours);
  leave<Forest::Taker>(node);
  place<Forest::Taker>(node, parent.way, parent.depth + 1);
  return true;
}

}  // namespace vdbfuse::mincut
