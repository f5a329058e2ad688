// SPDX-License-Identifier: Apache-2.0
// The network as the search sees it: a *load* travels from the giver's forest to the taker's.
//
// Forward: the giver is the source forest and a load is an excess. Reversed: the giver is the sink forest and
// a load is a deficit, which travels against the arcs. The search is written once, for loads.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "state.h"

namespace vdbfuse::mincut {

enum class Forest : std::uint8_t { Giver, Taker };
constexpr Forest opposite(Forest forest) { return forest == Forest::Giver ? Forest::Taker : Forest::Giver; }

/// How to get from a node to a neighbour: a lattice direction (< 6), or kFirstListed + a listed arc.
using Way = std::uint32_t;
inline constexpr Way kFirstListed = 16;
inline constexpr Way kRoot = 7;    ///< in place of a way to a parent: there is none
inline constexpr Way kOrphan = 8;  ///< … there is none any more
inline constexpr Way kNoWay = 0xffffffff;
constexpr bool isListed(Way way) { return way >= kFirstListed; }

/// The lattice neighbours of a node, by direction; slots of the tile without nodes where there is none.
using Around = std::array<std::uint32_t, lattice::kDirections>;

template <bool Reversed>
class LoadFlow {
 public:
  /// Stays within the tiles [first, last): lattice links out of them must be closed (see ClosedRegion).
  LoadFlow(State& state, std::uint32_t first, std::uint32_t last)
      : s_(state), first_(first), count_(last - first) {}

 protected:
  template <Forest F>
  static constexpr bool kIsSource = (F == Forest::Giver) != Reversed;

  template <Forest F>
  std::uint64_t& members(std::uint32_t tile) {
    return kIsSource<F> ? s_.tiles[tile].source : s_.tiles[tile].sink;
  }
  bool isHere(std::uint32_t node) const { return tileOf(node) - first_ < count_; }

  Around around(std::uint32_t node) const {
    Around result;
#pragma GCC unroll 6
    for (int d = 0; d < lattice::kDirections; ++d) result[d] = s_.neighbour(node, d);
    return result;
  }

  std::uint32_t head(std::uint32_t node, Way way) const {
    return isListed(way) ? s_.heads[way - kFirstListed] : s_.neighbour(node, static_cast<int>(way));
  }
  /// The same way seen from the other end.
  Way back(Way way) const { return isListed(way) ? s_.mates[way - kFirstListed] + kFirstListed : way ^ 1; }
  std::uint32_t& residual(std::uint32_t node, Way way) {
    return isListed(way) ? s_.arc_residual[way - kFirstListed]
                         : s_.residual[State::latticeArc(node, static_cast<int>(way))];
  }
  /// Bit d: load can move towards a parent of forest F in direction d (from a giver's parent: towards here).
  template <Forest F>
  std::uint32_t roomsToParent(std::uint32_t node, const Around& neighbours) const {
    const Tile& tile = s_.tiles[tileOf(node)];
    std::uint32_t rooms = 0;
#pragma GCC unroll 6
    for (int d = 0; d < lattice::kDirections; ++d) {
      const std::uint32_t other = neighbours[d];
      const std::uint64_t open = kIsSource<F>
                                     ? s_.tiles[tileOf(other)].open[lattice::opposite(d)] >> slotOf(other)
                                     : tile.open[d] >> slotOf(node);
      rooms |= static_cast<std::uint32_t>(open & 1) << d;
    }
    return rooms;
  }
  /// The same for a listed arc to a would-be parent.
  template <Forest F>
  bool hasRoomToParent(std::uint32_t arc) const {
    return s_.arc_residual[kIsSource<F> ? s_.mates[arc] : arc] > 0;
  }

  std::int64_t load(std::uint32_t node) const { return Reversed ? -s_.excess[node] : s_.excess[node]; }
  void addLoad(std::uint32_t node, std::int64_t amount) { s_.excess[node] += Reversed ? -amount : amount; }

  /// A way between two nodes, and where its residuals are.
  struct Passage {
    std::uint32_t from, to;  ///< load moves from here to there
    Way way, way_back;
    std::uint32_t* room;  ///< how much can move
    std::uint32_t* room_back;
  };
  Passage passage(std::uint32_t node, Way way, std::uint32_t neighbour) {
    const Way way_back = back(way);
    std::uint32_t* there = &residual(node, way);
    std::uint32_t* here = &residual(neighbour, way_back);
    return {node, neighbour, way, way_back, Reversed ? here : there, Reversed ? there : here};
  }

  /// Moves load; true if that fills the way. Loads of both ends are the caller's.
  bool move(const Passage& passage, std::uint32_t amount) {
    const bool opens = *passage.room_back == 0;
    *passage.room -= amount;
    *passage.room_back += amount;
    const bool fills = *passage.room == 0;
    if (isListed(passage.way) || !(opens || fills)) return fills;
    std::uint64_t& there = s_.tiles[tileOf(passage.from)].open[passage.way];
    std::uint64_t& here = s_.tiles[tileOf(passage.to)].open[passage.way_back];
    if (opens) Reversed ? there |= bitOf(passage.from) : here |= bitOf(passage.to);
    if (fills) Reversed ? here &= ~bitOf(passage.to) : there &= ~bitOf(passage.from);
    return fills;
  }

  /// Calls visit(arc, neighbour) for the listed arcs of a joined node that stay here, until it says stop.
  template <typename Visit>
  bool anyListedArc(std::uint32_t node, const Visit& visit) const {
    for (const std::uint32_t arc : s_.arcs(node)) {
      if (isHere(s_.heads[arc]) && visit(arc, s_.heads[arc])) return true;
    }
    return false;
  }

  State& s_;

 private:
  std::uint32_t first_, count_;
};

}  // namespace vdbfuse::mincut
