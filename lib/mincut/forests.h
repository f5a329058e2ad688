// SPDX-License-Identifier: Apache-2.0
// The heart of the minimum cut: two forests of shortest paths that grow towards each other.
//
// Vocabulary. The *source forest* holds every node that residual arcs lead to from a node with an excess, as
// far as it has grown; the *sink forest* every node from which residual arcs lead to a node with a deficit.
// Roots are the nodes with an excess (a deficit), at level 1 at the start; a child is one level deeper than
// its parent. The forests grow in turn, a level at a time. Where a residual arc leads from the source forest
// to the sink forest (a *bridge*) it is filled at once: its head gets an excess, its tail a deficit. Both
// travel rootwards, deepest level first, so that what comes from many bridges meets and travels together. A
// node whose arc to its parent is filled, and a root that is used up, is an *orphan*: it takes the nearest
// other parent, shallowest level first, or leaves the forest. An excess that cannot leave the sink forest so
// ends in a node that changes forest and becomes a root there; the same for deficits.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/mincut/network.h"
#include "vdbfuse/mincut/solve.h"

namespace vdbfuse::mincut {

enum class Tree : std::uint8_t { Source, Sink };

/// Reversed: the solver sees every arc the other way round, and demand as supply. The source forest is the
/// one in which excess is carried on to where it may be needed next, so that it should be the one with fewer
/// roots.
enum class Orientation : std::uint8_t { AsGiven, Reversed };

constexpr Tree opposite(Tree tree) { return tree == Tree::Source ? Tree::Sink : Tree::Source; }

/// Nodes waiting to be processed, by level, each with an arc that goes with it. A node may wait more than
/// once.
class LevelQueue {
 public:
  struct Item {
    std::uint32_t node;
    std::uint32_t arc;
  };
  bool empty() const { return size_ == 0; }
  void push(Item item, std::int32_t level);
  /// Takes an item off the lowest (highest) level. REQUIRES: not empty.
  Item popLowest();
  Item popHighest();
  /// Level of the item that was taken last.
  std::int32_t level() const { return level_; }
  std::size_t bytes() const;

 private:
  struct Link {
    Item item;
    std::uint32_t next;
  };
  static constexpr std::uint32_t kEnd = 0xffffffff;
  Item pop(std::int32_t level);

  std::vector<std::uint32_t> tops_;  ///< by level: first of its links, or kEnd
  std::vector<Link> links_;          ///< emptied whenever the queue is
  std::size_t size_ = 0;
  std::int32_t lowest_ = 0;
  std::int32_t highest_ = 0;
  std::int32_t level_ = 0;
};

class Forests {
 public:
  Forests(const Network& network, Orientation orientation, const Progress& progress);

  /// Grows both forests until one cannot grow any more: the flow is maximum.
  void maximiseFlow();
  /// Grows this forest alone to its end. After maximiseFlow() nothing is left to meet: it ends as the set of
  /// all nodes that its roots are connected with.
  template <Tree T>
  void exhaust();

  /// Moves the result out; `ties` names the forest that was exhausted.
  MinCut takeResult(CutTies ties);

 private:
  /// Nodes on a forest's deepest level, whose arcs out of the forest nobody has looked at yet.
  struct Frontier {
    std::vector<std::uint32_t> nodes;     ///< may hold nodes that have left the level since
    std::vector<std::uint32_t> scanning;  ///< the level above while the forest grows
    std::int32_t level = 1;
    bool growing = false;
  };

  static constexpr std::uint32_t kRoot = 0xffffffff;
  static constexpr std::uint32_t kOrphan = 0xfffffffe;
  static constexpr std::uint32_t kNoArc = 0xfffffffd;

  template <Tree T>
  static std::int32_t levelAt(std::int32_t depth) {
    return T == Tree::Source ? depth : -depth;
  }
  template <Tree T>
  std::int32_t depth(std::uint32_t node) const {
    return levelAt<T>(level_[node]);
  }
  template <Tree T>
  bool isIn(std::uint32_t node) const {
    return depth<T>(node) > 0;
  }
  /// What could still be pushed along `arc` (against it, in the source forest) on the way to the root.
  template <Tree T>
  std::uint32_t room(std::uint32_t arc) const {
    return residual_[T == Tree::Source ? network_.mate(arc) : arc];
  }
  template <Tree T>
  Frontier& frontier() {
    return frontiers_[static_cast<std::size_t>(T)];
  }

  void settleNeighbours();
  void turnBack();
  template <Tree T>
  void place(std::uint32_t node, std::uint32_t parent, std::int32_t depth);
  template <Tree T>
  void growLevel();
  template <Tree T>
  void scan(std::uint32_t node);
  void fillBridge(std::uint32_t arc, std::uint32_t tail);
  std::int64_t supply(std::uint32_t node) const;
  void pull(std::uint32_t node, std::uint32_t amount);
  void push(std::uint32_t arc, std::uint32_t amount);
  bool mustPush(std::uint32_t node) const;
  void arrive(std::uint32_t node, std::uint32_t amount);
  void drain();
  void pushRootwards(std::uint32_t node);
  template <Tree T>
  void orphan(std::uint32_t node);
  template <Tree T>
  void mend();
  template <Tree T>
  void keepOrDetach(std::uint32_t node, std::uint32_t old_parent);
  template <Tree T>
  std::uint32_t parentAt(std::int32_t wanted, std::uint32_t node, std::uint32_t old_parent) const;
  template <Tree T>
  std::uint32_t nearestParent(std::uint32_t node) const;
  template <Tree T>
  void orphanChildren(std::uint32_t node);
  template <Tree T>
  void reattach(std::uint32_t node, std::uint32_t parent, std::int32_t depth);
  template <Tree T>
  void release(std::uint32_t node);
  void tick();

  const Network& network_;
  Orientation orientation_;
  const Progress& progress_;
  std::vector<std::uint32_t> residual_;
  std::vector<std::int64_t> excess_;  ///< terminal + inflow − outflow
  std::vector<std::uint32_t>
      parent_;  ///< arc to the parent, kRoot or kOrphan; means nothing where the level is 0
  std::vector<std::int32_t> level_;  ///< > 0: source forest, < 0: sink forest, 0: neither
  std::array<Frontier, 2> frontiers_;
  LevelQueue loads_;
  LevelQueue orphans_;
  std::vector<std::uint32_t> detached_;
  std::vector<std::uint32_t> loaded_;
  SolveStatistics statistics_;
  std::uint64_t ticks_ = 0;
  std::uint64_t in_forests_ = 0;
};

}  // namespace vdbfuse::mincut
