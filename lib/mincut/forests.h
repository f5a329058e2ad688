// SPDX-License-Identifier: Apache-2.0
// The heart of the minimum cut: two forests of shortest paths that grow towards each other.
//
// The *giver's forest* holds every node that load can reach from a node with load, as far as it has grown;
// the *taker's forest* every node from which load can reach a node that wants it. Roots are the nodes with
// load (with demand), at level 1 at the start; a child is one level deeper than its parent. The forests grow
// a level at a time, a whole tile in a few shifts of machine words. Where they meet, a *bridge* leads from
// the giver to the taker, and as much is pushed along it as the path from the root of its tail can supply. In
// the taker's forest this load travels rootwards, deepest level first, so that what comes from the bridges of
// several tiles travels together. A node whose way to its parent is filled, and a root that is used up, is an
// *orphan*. An orphan with load takes the nearest parent at once and passes it on; its children, and all
// other orphans, wait until no load is under way; then the forest is mended in one go: each takes the nearest
// other parent or leaves the forest. A load that cannot get on ends in a node that leaves the taker's forest
// and becomes a root of the giver's forest, close to where it will be needed next.
//
// This is one-sided on purpose. If bridges were filled without regard to the supply, demand would travel in
// the giver's forest just so, but then wide edges between small terminals can send the same load to and fro
// for ever. As it is, no demand is ever made: levels in the taker's forest stay lower bounds of the distance
// to a demand, below the number of nodes; between two of its growths it only loses nodes, or they sink; and
// the giver's forest grows anew only so often as it loses them. So the loop ends, whatever the capacities
// are.
//
// Invariants between two steps, from which all else follows (frontier: a forest's deepest level; the forest
// that is growing has the frontier one deeper than the level it is scanning):
//   1. Load is only in the giver's forest, demand only in the taker's.
//   2. From a node on a level above the frontier (and already scanned, on the level being scanned) no load
//   can move out of the giver's forest; to such a node none can move from outside the taker's forest.
//   3. A way with room does not lead from one level to one more than one deeper (giver), the other way round
//   for the taker.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "level_queue.h"
#include "load_flow.h"
#include "vdbfuse/base/progress.h"
#include "vdbfuse/mincut/solve.h"

namespace vdbfuse::mincut {

/// What the forests know of each node. Regions share one of these, each its own part.
struct ForestNodes {
  explicit ForestNodes(const State& state);
  Buffer<std::int32_t> level;           ///< > 0: giver's forest, < 0: taker's, 0: neither
  Buffer<std::uint8_t> parent;          ///< a direction, kListed, kRoot or kOrphan
  Buffer<std::uint32_t> listed_parent;  ///< by row: the listed arc when `parent` says kListed
};

template <bool Reversed>
class Forests : LoadFlow<Reversed> {
 public:
  /// Makes roots of the marked sources and sinks of a tile (roots.h).
  static void plantTile(State& state, ForestNodes& nodes, std::uint32_t tile);

  /// Of the tiles [first, last) only, in which roots have been planted.
  Forests(State& state, ForestNodes& nodes, std::uint32_t first, std::uint32_t last,
          const Progress& progress);

  /// Grows both forests until one cannot grow any more: the flow is maximum within the region. May throw
  /// Cancelled; the network's flow is a valid one then.
  void maximiseFlow();
  const SolveStatistics& statistics() const { return statistics_; }

 private:
  using Flow = LoadFlow<Reversed>;
  using Flow::addLoad, Flow::anyListedArc, Flow::around, Flow::back, Flow::head, Flow::isHere, Flow::load,
      Flow::move, Flow::s_;
  static constexpr std::uint8_t kListed = 6;

  /// Nodes of one tile on a forest's two deepest levels that nobody has scanned yet, by the level's parity.
  struct Front {
    std::array<std::uint64_t, 2> nodes{};
  };
  /// A forest's deepest level, and while it grows also the level above, which is being scanned.
  struct Frontier {
    std::vector<Front> fronts;                        ///< a tile each
    std::array<std::vector<std::uint32_t>, 2> tiles;  ///< that have (or had) nodes in the front, by parity
    std::array<std::uint64_t, 2> sizes{};             ///< nodes that were put there
    std::int32_t level = 1;
    bool growing = false;
  };
  struct Parent {
    Way way = kNoWay;
    std::int32_t depth = 0;
  };

  template <Forest F>
  static std::int32_t levelAt(std::int32_t depth) {
    return F == Forest::Giver ? depth : -depth;
  }
  template <Forest F>
  std::int32_t depth(std::uint32_t node) const {
    return levelAt<F>(nodes_.level[node]);
  }
  template <Forest F>
  bool isIn(std::uint32_t node) const {
    return depth<F>(node) > 0;
  }
  template <Forest F>
  Frontier& frontier() {
    return frontiers_[static_cast<std::size_t>(F)];
  }
  template <Forest F>
  std::uint64_t& front(std::uint32_t tile, std::int32_t depth) {
    return frontier<F>().fronts[tile - first_].nodes[depth & 1];
  }
  template <Forest F>
  LevelQueue& orphans() {
    return orphans_[static_cast<std::size_t>(F)];
  }
  bool isOrphan(std::uint32_t node) const { return nodes_.parent[node] == kOrphan; }
  Way wayToParent(std::uint32_t node) const;
  void setParent(std::uint32_t node, Way way);

  // forests_grow.h: roots, fronts and levels
  template <Forest F>
  double reluctance();
  template <Forest F>
  void addToFront(std::uint32_t tile, std::uint64_t nodes, std::int32_t depth);
  template <Forest F>
  void place(std::uint32_t node, Way way, std::int32_t depth);
  template <Forest F>
  void leave(std::uint32_t node);
  template <Forest F>
  void growLevel();
  template <Forest F>
  void scanTile(std::uint32_t tile, std::int32_t depth);
  template <Forest F>
  void join(std::uint32_t tile, std::uint64_t nodes, int direction, std::int32_t depth);
  template <Forest F>
  bool takeFree(std::uint32_t tile, std::uint64_t nodes, int direction, std::int32_t depth);
  template <Forest F>
  std::uint64_t contacts(std::uint32_t tile, std::uint64_t nodes, int direction);
  template <Forest F>
  bool fillBridges(std::uint32_t tile, int direction, std::int32_t depth);
  template <Forest F>
  bool scanListed(std::uint32_t node, std::int32_t depth);

  // forests_push.h: load on its way
  template <Forest F>
  void bridge(std::uint32_t node, Way way);
  void fillBridge(std::uint32_t tail, Way way, std::uint32_t tip);
  std::int64_t supply(std::uint32_t node);
  void pull(std::uint32_t node, std::uint32_t amount);
  bool mustPush(std::uint32_t node) const;
  void arrive(std::uint32_t node, std::uint32_t amount);
  void drain();
  void pushRootwards(std::uint32_t node);
  void loseParent(std::uint32_t node, Way old);
  bool takeParentAtOnce(std::uint32_t node);

  // forests_mend.h: orphans
  template <Forest F>
  void orphan(std::uint32_t node);
  template <Forest F>
  void mend();
  template <Forest F>
  void keepOrDetach(std::uint32_t node);
  template <Forest F>
  Way parentAt(std::int32_t depth, std::uint32_t node, const Around& neighbours) const;
  template <Forest F>
  Parent nearestParent(std::uint32_t node, std::int32_t limit, const Around& neighbours) const;
  template <Forest F>
  void orphanChildren(std::uint32_t node, std::int32_t depth, const Around& neighbours);
  template <Forest F>
  void reattach(std::uint32_t node, Way way, std::int32_t depth);
  template <Forest F>
  void release(std::uint32_t node);
  std::uint32_t atLevel(std::int32_t level, const Around& neighbours) const;

  void report();
  std::size_t bytes() const;

  ForestNodes& nodes_;
  std::uint32_t first_, last_;
  const Progress& progress_;
  std::array<Frontier, 2> frontiers_;
  LevelQueue loads_;                          ///< nodes of the taker's forest with load to push on
  std::array<LevelQueue, 2> orphans_;         ///< by forest
  std::vector<std::uint32_t> detached_;       ///< orphans that could not keep their level
  std::vector<std::uint32_t> loaded_;         ///< orphans with load
  std::vector<typename Flow::Passage> path_;  ///< from a bridge's tail to its root
  SolveStatistics statistics_;
  std::array<std::uint64_t, 2> mended_{};  ///< by forest: orphans that could not keep their level
};

}  // namespace vdbfuse::mincut
