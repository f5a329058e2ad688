// SPDX-License-Identifier: Apache-2.0
// Part of forests.h: orphans.
#pragma once

#include "forests.h"

namespace vdbfuse::mincut {

template <bool R>
template <Forest F>
void Forests<R>::orphan(std::uint32_t node) {
  nodes_.parent[node] = kOrphan;
  orphans<F>().push({node, kNoWay}, depth<F>(node));
}

/// Gives every orphan the nearest parent there is, and levels that are exact again, at a cost that depends on
/// the number of nodes that cannot keep their level and on nothing else. First, from the root downwards, a
/// node keeps its level if another parent allows it and is detached if not, which makes orphans of its
/// children. Then the detached nodes join again in order of their new levels, or leave the forest. (Deciding
/// node by node would let the nodes of a cut-off subtree adopt each other and sink one level at a time.)
template <bool R>
template <Forest F>
void Forests<R>::mend() {
  LevelQueue& waiting = orphans<F>();
  while (!waiting.empty()) keepOrDetach<F>(waiting.popLowest().node);
  for (const std::uint32_t node : detached_) {
    const Parent parent = nearestParent<F>(node, frontier<F>().level, around(node));
    if (parent.way != kNoWay) waiting.push({node, parent.way}, parent.depth + 1);
  }
  while (!waiting.empty()) {
    const LevelQueue::Item offer = waiting.popLowest();
    if (nodes_.level[offer.node] == 0) reattach<F>(offer.node, offer.way, waiting.level());
  }
  for (const std::uint32_t node : detached_) {
    if (nodes_.level[node] == 0) release<F>(node);
  }
  detached_.clear();
}

template <bool R>
template <Forest F>
void Forests<R>::keepOrDetach(std::uint32_t node) {
  if (!isOrphan(node) || nodes_.level[node] == 0) return;  // it waited twice, or has found a parent
  const std::int32_t depth_now = depth<F>(node);
  const Around neighbours = around(node);
  const Way way = parentAt<F>(depth_now - 1, node, neighbours);
  if (way != kNoWay) {
    ++statistics_.adoptions;
    setParent(node, way);
    return;
  }
  orphanChildren<F>(node, depth_now, neighbours);
  leave<F>(node);
  detached_.push_back(node);
  ++mended_[static_cast<std::size_t>(F)];
}

/// Bit d: the neighbour in direction d is at this level.
template <bool R>
std::uint32_t Forests<R>::atLevel(std::int32_t level, const Around& neighbours) const {
  std::uint32_t found = 0;
#pragma GCC unroll 6
  for (int d = 0; d < lattice::kDirections; ++d)
    found |= static_cast<std::uint32_t>(nodes_.level[neighbours[d]] == level) << d;
  return found;
}

/// A way with room to a node at this depth, or kNoWay.
template <bool R>
template <Forest F>
Way Forests<R>::parentAt(std::int32_t wanted, std::uint32_t node, const Around& neighbours) const {
  if (wanted == 0) return kNoWay;
  const std::uint32_t found =
      atLevel(levelAt<F>(wanted), neighbours) & Flow::template roomsToParent<F>(node, neighbours);
  if (found != 0) return static_cast<Way>(std::countr_zero(found));
  Way way = kNoWay;
  if (!s_.isJoined(node)) return way;
  anyListedArc(node, [&](std::uint32_t arc, std::uint32_t neighbour) {
    if (depth<F>(neighbour) != wanted || !Flow::template hasRoomToParent<F>(arc)) return false;
    way = arc + kFirstListed;
    return true;
  });
  return way;
}

/// The way with room to the shallowest node above depth `limit`.
template <bool R>
template <Forest F>
typename Forests<R>::Parent Forests<R>::nearestParent(std::uint32_t node, std::int32_t limit,
                                                      const Around& neighbours) const {
  Parent nearest{kNoWay, limit};
  std::uint32_t rooms = Flow::template roomsToParent<F>(node, neighbours);
  for (; rooms != 0; rooms &= rooms - 1) {
    const auto way = static_cast<Way>(std::countr_zero(rooms));
    const std::int32_t there = depth<F>(neighbours[way]);
    if (there > 0 && there < nearest.depth) nearest = {way, there};
  }
  if (!s_.isJoined(node)) return nearest;
  anyListedArc(node, [&](std::uint32_t arc, std::uint32_t neighbour) {
    const std::int32_t there = depth<F>(neighbour);
    if (there > 0 && there < nearest.depth && Flow::template hasRoomToParent<F>(arc))
      nearest = {arc + kFirstListed, there};
    return false;
  });
  return nearest;
}

template <bool R>
template <Forest F>
void Forests<R>::orphanChildren(std::uint32_t node, std::int32_t depth_now, const Around& neighbours) {
  const std::int32_t level_of_children = levelAt<F>(depth_now + 1);
  for (std::uint32_t found = atLevel(level_of_children, neighbours); found != 0; found &= found - 1) {
    const int d = std::countr_zero(found);
    if (nodes_.parent[neighbours[d]] == lattice::opposite(d)) orphan<F>(neighbours[d]);
  }
  if (!s_.isJoined(node)) return;
  anyListedArc(node, [&](std::uint32_t arc, std::uint32_t child) {
    if (nodes_.level[child] == level_of_children && wayToParent(child) == s_.mates[arc] + kFirstListed)
      orphan<F>(child);
    return false;
  });
}

/// A detached node joins at its new level and offers itself to its detached neighbours. Offers come
/// shallowest first: the first is the best.
template <bool R>
template <Forest F>
void Forests<R>::reattach(std::uint32_t node, Way way, std::int32_t new_depth) {
  ++statistics_.adoptions;
  place<F>(node, way, new_depth);
  if (new_depth == frontier<F>().level) return;
  const Around neighbours = around(node);
  const auto offer = [&](std::uint32_t neighbour, Way way_here) {
    if (isOrphan(neighbour)) orphans<F>().push({neighbour, way_here}, new_depth + 1);
  };
  std::uint32_t found = atLevel(0, neighbours) & Flow::template roomsToParent<opposite(F)>(node, neighbours);
  for (; found != 0; found &= found - 1) {
    const int d = std::countr_zero(found);
    offer(neighbours[d], static_cast<Way>(lattice::opposite(d)));
  }
  if (!s_.isJoined(node)) return;
  anyListedArc(node, [&](std::uint32_t arc, std::uint32_t neighbour) {
    if (nodes_.level[neighbour] == 0 && Flow::template hasRoomToParent<F>(s_.mates[arc]))
      offer(neighbour, s_.mates[arc] + kFirstListed);
    return false;
  });
}

/// The node leaves the forest. If it leaves the taker's forest with load it becomes a root of the giver's
/// forest, on the deepest level: nothing is known of what surrounds it there.
template <bool R>
template <Forest F>
void Forests<R>::release(std::uint32_t node) {
  ++statistics_.releases;
  setParent(node, kRoot);
  if (load(node) > 0) place<Forest::Giver>(node, kRoot, frontier<Forest::Giver>().level);
}

}  // namespace vdbfuse::mincut
