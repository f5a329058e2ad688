// SPDX-License-Identifier: Apache-2.0
// The heart of the minimum cut: two forests of shortest paths that grow towards each other.
//
// The *source forest* holds every node that a residual path leads to from a node with an excess, as far as it
// has grown; the *sink forest* every node from which a residual path leads to a node with a deficit. Roots
// are the nodes with an excess (a deficit), at level 1 at the start; a child is one level deeper than its
// parent. The forests grow a level at a time. Where they meet, a residual arc (a *bridge*) leads from the
// source forest to the sink forest, and as much is pushed along it as the path from the root of its tail can
// supply. In the sink forest this excess travels rootwards, deepest level first, so that what comes from many
// bridges travels together. A node whose arc to its parent is filled, and a root that is used up, is an
// *orphan*: it takes the nearest other parent or leaves the forest. An excess that cannot get on then ends in
// a node that leaves the sink forest and becomes a root of the source forest, close to where it will be
// needed next.
//
// This is one-sided on purpose. If bridges were filled without regard to the supply, deficits would travel in
// the source forest just so, but then wide edges between small terminals can send the same excess to and fro
// for ever. As it is, no deficit is ever made: levels in the sink forest stay lower bounds of the distance to
// a deficit, below the number of nodes; between two of its growths it only loses nodes, or they sink; and the
// source forest grows anew only so often as it loses them. So the loop ends, whatever the capacities are.
//
// Invariants between two steps, from which all else follows (D: level of a forest's frontier; the forest that
// is growing has the frontier one deeper than the level it is scanning):
//   1. Excess is only in the source forest, deficit only in the sink forest.
//   2. A node on a level above the frontier (and already scanned, on the level being scanned) has no residual
//   arc out of
//      its forest (source forest), no residual arc from outside to it (sink forest).
//   3. A residual arc does not lead to a level more than one deeper (source forest), or from one (sink
//   forest).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "level_queue.h"
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

class Forests {
 public:
  Forests(const Network& network, Orientation orientation, const Progress& progress);

  /// Grows both forests until one cannot grow any more: the flow is maximum.
  void maximiseFlow();
  /// After maximiseFlow(): puts into this forest all nodes that its roots are connected with. The forests do
  /// not meet any more, so that only nodes in neither are concerned.
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
  template <Tree T>
  double reluctance() const;
  template <Tree T>
  bool reaches(std::uint32_t node) const;
  template <Tree T>
  void flood(std::uint32_t node);
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
  void turnBack();
  std::size_t bytes() const;

  const Network& network_;
  Orientation orientation_;
  const Progress& progress_;
  std::vector<std::uint32_t> residual_;
  std::vector<std::int64_t> excess_;   ///< terminal + inflow − outflow
  std::vector<std::uint32_t> parent_;  ///< arc to the parent, kRoot or kOrphan
  std::vector<std::int32_t> level_;    ///< > 0: source forest, < 0: sink forest, 0: neither
  std::array<Frontier, 2> frontiers_;
  LevelQueue loads_;                     ///< nodes of the sink forest with an excess to push on
  LevelQueue orphans_;                   ///< of the forest that is being mended
  std::vector<std::uint32_t> detached_;  ///< orphans that could not keep their level
  std::vector<std::uint32_t> loaded_;    ///< orphans with an excess
  SolveStatistics statistics_;
  std::uint64_t ticks_ = 0;
  std::uint64_t in_forests_ = 0;
};

}  // namespace vdbfuse::mincut
