// SPDX-License-Identifier: Apache-2.0
// Part of forests.h: roots, fronts and levels.
#pragma once

#include "forests.h"

namespace vdbfuse::mincut {

/// Loads of so many tiles travel together. More of them overshoot where evidence is dense, fewer meet where
/// it is sparse; between 1 and 500 that is up to a fifth of the time, either way.
inline constexpr std::size_t kTilesPerDrain = 16;
/// Orphans a tile that had better not decide which forest grows.
inline constexpr double kLittleMendingPerTile = 3.0;

template <bool R>
Forests<R>::Forests(State& state, ForestNodes& nodes, std::uint32_t first, std::uint32_t last,
                    const Progress& progress)
    : Flow(state, first, last), nodes_(nodes), first_(first), last_(last), progress_(progress) {
  for (Frontier& frontier : frontiers_) frontier.fronts.resize(last - first);
}

template <bool R>
void Forests<R>::maximiseFlow() {
  for (std::uint32_t tile = first_; tile < last_; ++tile) {
    const std::uint64_t givers = Flow::template members<Forest::Giver>(tile);
    const std::uint64_t takers = Flow::template members<Forest::Taker>(tile);
    if (givers != 0) addToFront<Forest::Giver>(tile, givers, 1);
    if (takers != 0) addToFront<Forest::Taker>(tile, takers, 1);
  }
  const auto can_grow = [](const Frontier& f) { return !f.tiles[f.level & 1].empty(); };
  while (can_grow(frontiers_[0]) && can_grow(frontiers_[1])) {
    if (reluctance<Forest::Giver>() <= reluctance<Forest::Taker>()) {
      growLevel<Forest::Giver>();
    } else {
      growLevel<Forest::Taker>();
    }
  }
  statistics_.bytes = bytes();
}

/// The marked sources and sinks of the tile become roots, all other nodes free. The caller may do this for
/// many tiles at once.
template <bool R>
void Forests<R>::plantTile(State& state, ForestNodes& nodes, std::uint32_t t) {
  const Tile& tile = state.tiles[t];
  const std::uint64_t givers = R ? tile.sink : tile.source, takers = R ? tile.source : tile.sink;
  std::int32_t* level = &nodes.level[std::size_t{t} * lattice::kSlots];
  for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot)
    level[slot] =
        static_cast<std::int32_t>(givers >> slot & 1) - static_cast<std::int32_t>(takers >> slot & 1);
  std::fill_n(&nodes.parent[std::size_t{t} * lattice::kSlots], lattice::kSlots,
              static_cast<std::uint8_t>(kRoot));
}

/// Forests of equal depth meet halfway and on short paths, and little is cut off from its root when an arc of
/// such a path is filled; a wide shallow forest may wait a little while a narrow one grows. (Growing always
/// the narrower one took up to 35 times the adoptions where evidence is sparse; strict turns scan every root
/// in vain where it is dense.) And the forest that has had to be mended more grows less: it is the one whose
/// roots are weak, and the deeper it is the more hangs on them. (That takes up to a fifth of the time off
/// shadows of one-sided scans, and is no loss elsewhere.)
template <bool R>
template <Forest F>
double Forests<R>::reluctance() {
  const Frontier& deepest = frontier<F>();
  const double level = deepest.level;
  const double little = kLittleMendingPerTile * static_cast<double>(last_ - first_);
  const double mended = static_cast<double>(mended_[static_cast<std::size_t>(F)]) + little;
  return mended * mended * level * level * level * level *
         static_cast<double>(deepest.sizes[deepest.level & 1]);
}

template <bool R>
template <Forest F>
void Forests<R>::addToFront(std::uint32_t tile, std::uint64_t nodes, std::int32_t depth) {
  std::uint64_t& waiting = front<F>(tile, depth);
  if (waiting == 0) frontier<F>().tiles[depth & 1].push_back(tile);
  waiting |= nodes;
  frontier<F>().sizes[depth & 1] += static_cast<std::uint64_t>(std::popcount(nodes));
}

/// Gives the node its place in the forest; on the deepest levels that makes it one to scan.
template <bool R>
template <Forest F>
void Forests<R>::place(std::uint32_t node, Way way, std::int32_t depth) {
  setParent(node, way);
  nodes_.level[node] = levelAt<F>(depth);
  Flow::template members<F>(tileOf(node)) |= bitOf(node);
  const Frontier& deepest = frontier<F>();
  if (depth == deepest.level || (deepest.growing && depth == deepest.level - 1))
    addToFront<F>(tileOf(node), bitOf(node), depth);
}

/// Takes the node out of the forest and its fronts.
template <bool R>
template <Forest F>
void Forests<R>::leave(std::uint32_t node) {
  nodes_.level[node] = 0;
  Flow::template members<F>(tileOf(node)) &= ~bitOf(node);
  for (std::uint64_t& waiting : frontier<F>().fronts[tileOf(node) - first_].nodes) waiting &= ~bitOf(node);
}

template <bool R>
template <Forest F>
void Forests<R>::growLevel() {
  ++statistics_.passes;
  report();
  Frontier& deepest = frontier<F>();
  const std::int32_t depth = deepest.level++;
  deepest.growing = true;
  std::vector<std::uint32_t>& tiles = deepest.tiles[depth & 1];
  for (std::size_t i = 0; i < tiles.size(); ++i) {  // grows while it runs
    scanTile<F>(tiles[i], depth);
    if (i % kTilesPerDrain == 0 || i + 1 == tiles.size()) drain();
  }
  tiles.clear();
  deepest.sizes[depth & 1] = 0;
  deepest.growing = false;
}

/// Until no node of the tile's front has a way to a free node or to the other forest.
template <bool R>
template <Forest F>
void Forests<R>::scanTile(std::uint32_t tile, std::int32_t depth) {
  std::uint64_t& waiting = front<F>(tile, depth);
  ++statistics_.tiles;
  statistics_.scans += static_cast<std::uint64_t>(std::popcount(waiting));
  while (waiting != 0) {
    const std::uint64_t nodes = waiting;
    std::uint32_t bridges = 0;  // bit d: there are some in direction d
#pragma GCC unroll 6
    for (int d = 0; d < lattice::kDirections; ++d)
      bridges |= static_cast<std::uint32_t>(takeFree<F>(tile, nodes, d, depth + 1)) << d;
    bool changed = false;
    for (std::uint64_t joined = waiting & s_.tiles[tile].joined; joined != 0; joined &= joined - 1) {
      const std::uint32_t node = lowestNode(tile, joined);
      if ((waiting & bitOf(node)) != 0) changed |= scanListed<F>(node, depth);
    }
    for (; bridges != 0; bridges &= bridges - 1)
      changed |= fillBridges<F>(tile, std::countr_zero(bridges), depth);
    if (!changed) waiting = 0;
  }
}

/// All these nodes of the tile become children, at this depth, of their neighbours in this direction.
template <bool R>
template <Forest F>
void Forests<R>::join(std::uint32_t tile, std::uint64_t nodes, int direction, std::int32_t depth) {
  Flow::template members<F>(tile) |= nodes;
  addToFront<F>(tile, nodes, depth);
  for (; nodes != 0; nodes &= nodes - 1) {
    const std::uint32_t node = lowestNode(tile, nodes);
    nodes_.level[node] = levelAt<F>(depth);
    nodes_.parent[node] = static_cast<std::uint8_t>(direction);
  }
}

/// Free nodes that these nodes of the tile can reach in this direction join the forest; true if nodes of the
/// other forest are reached. (That an arc has residual says that the node at its other end exists.)
template <bool R>
template <Forest F>
bool Forests<R>::takeFree(std::uint32_t t, std::uint64_t nodes, int direction, std::int32_t depth) {
  constexpr bool kSource = Flow::template kIsSource<F>;
  const int reverse = lattice::opposite(direction);
  const Tile& tile = s_.tiles[t];
  if (kSource) nodes &= tile.open[direction];
  bool meets_other = false;
  const auto take = [&](std::uint32_t there, std::uint64_t reached) {
    const Tile& other = s_.tiles[there];
    if (!kSource) reached &= other.open[reverse];
    meets_other |= (reached & (kSource ? other.sink : other.source)) != 0;
    const std::uint64_t free = reached & ~(other.source | other.sink);
    if (free != 0) join<F>(there, free, reverse, depth);
  };
  take(t, lattice::stepInside(nodes, direction));
  if ((nodes & lattice::kFace[direction]) != 0)
    take(tile.next[direction], lattice::stepAcross(nodes, direction));
  return meets_other;
}

/// Those of the nodes that have a bridge in this direction.
template <bool R>
template <Forest F>
std::uint64_t Forests<R>::contacts(std::uint32_t t, std::uint64_t nodes, int direction) {
  constexpr bool kSource = Flow::template kIsSource<F>;
  const int reverse = lattice::opposite(direction);
  const Tile& tile = s_.tiles[t];
  if (kSource) nodes &= tile.open[direction];
  const auto others = [&](const Tile& other) {
    return kSource ? other.sink : other.source & other.open[reverse];
  };
  std::uint64_t met = lattice::stepInside(others(tile), reverse);
  if ((nodes & lattice::kFace[direction]) != 0)
    met |= lattice::stepAcross(others(s_.tiles[tile.next[direction]]), reverse);
  return nodes & met;
}

template <bool R>
template <Forest F>
bool Forests<R>::fillBridges(std::uint32_t tile, int direction, std::int32_t depth) {
  const std::uint64_t& waiting = front<F>(tile, depth);
  bool any = false;
  while (const std::uint64_t nodes = contacts<F>(tile, waiting, direction)) {
    bridge<F>(lowestNode(tile, nodes), static_cast<Way>(direction));
    any = true;
  }
  return any;
}

/// Scans the listed arcs of a node of the front; true if something was pushed.
template <bool R>
template <Forest F>
bool Forests<R>::scanListed(std::uint32_t node, std::int32_t depth) {
  const std::uint64_t& waiting = front<F>(tileOf(node), depth);
  bool any = false;
  anyListedArc(node, [&](std::uint32_t arc, std::uint32_t neighbour) {
    const std::uint32_t mate = s_.mates[arc];
    if (isIn<F>(neighbour) || !Flow::template hasRoomToParent<F>(mate)) return false;
    if (nodes_.level[neighbour] != 0) {
      bridge<F>(node, arc + kFirstListed);
      any = true;
      if ((waiting & bitOf(node)) == 0) return true;
      if (nodes_.level[neighbour] != 0 || !Flow::template hasRoomToParent<F>(mate)) return false;
    }
    place<F>(neighbour, mate + kFirstListed, depth + 1);
    return false;
  });
  return any;
}

}  // namespace vdbfuse::mincut
