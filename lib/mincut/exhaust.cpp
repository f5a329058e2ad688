// SPDX-License-Identifier: Apache-2.0
#include "exhaust.h"

#include <vector>

namespace vdbfuse::mincut {
namespace {

class Flood {
 public:
  Flood(State& state, Side side) : s_(state), from_source_(side == Side::Source) {}

  void run() {
    for (std::uint32_t tile = 0; tile < s_.tileCount(); ++tile) {
      if (free(tile) != 0) open_.push_back(tile);
    }
    while (!open_.empty()) {
      const std::uint32_t tile = open_.back();
      open_.pop_back();
      if (spread(tile)) wakeNeighbours(tile);
    }
  }

 private:
  std::uint64_t free(std::uint32_t t) const {
    const Tile& tile = s_.tiles[t];
    return tile.nodes & ~(tile.source | tile.sink);
  }
  std::uint64_t& members(std::uint32_t t) { return from_source_ ? s_.tiles[t].source : s_.tiles[t].sink; }

  /// Nodes of the tile with a lattice way from (to) a member, free or not.
  std::uint64_t reached(std::uint32_t t) {
    const Tile& tile = s_.tiles[t];
    std::uint64_t result = 0;
    for (int d = 0; d < lattice::kDirections; ++d) {
      const int back = lattice::opposite(d);
      const Tile& next = s_.tiles[tile.next[d]];
      const std::uint64_t here = from_source_ ? tile.source & tile.open[back] : tile.sink;
      const std::uint64_t there = from_source_ ? next.source & next.open[back] : next.sink;
      const std::uint64_t met = lattice::stepInto(here, there, back);
      result |= from_source_ ? met : met & tile.open[d];
    }
    return result;
  }

  bool isReachedByListedArc(std::uint32_t node) {
    for (const std::uint32_t arc : s_.arcs(node)) {
      const std::uint32_t head = s_.heads[arc];
      if ((members(tileOf(head)) & bitOf(head)) == 0) continue;
      if (s_.arc_residual[from_source_ ? s_.mates[arc] : arc] > 0) return true;
    }
    return false;
  }

  bool spread(std::uint32_t tile) {
    const std::uint64_t before = members(tile);
    for (std::uint64_t found = ~std::uint64_t{0}; found != 0;) {
      found = reached(tile) & free(tile);
      for (std::uint64_t joined = free(tile) & ~found & s_.tiles[tile].joined; joined != 0;
           joined &= joined - 1) {
        const std::uint32_t node = lowestNode(tile, joined);
        if (isReachedByListedArc(node)) found |= bitOf(node);
      }
      members(tile) |= found;
    }
    return members(tile) != before;
  }

  void wakeNeighbours(std::uint32_t t) {
    const Tile& tile = s_.tiles[t];
    for (const std::uint32_t next : tile.next) {
      if (free(next) != 0) open_.push_back(next);
    }
    for (std::uint64_t joined = tile.joined & members(t); joined != 0; joined &= joined - 1) {
      for (const std::uint32_t arc : s_.arcs(lowestNode(t, joined))) {
        const std::uint32_t head = s_.heads[arc];
        if ((free(tileOf(head)) & bitOf(head)) != 0) open_.push_back(tileOf(head));
      }
    }
  }

  State& s_;
  bool from_source_;
  std::vector<std::uint32_t> open_;
};

}  // namespace

void exhaust(State& state, Side side) { Flood(state, side).run(); }

}  // namespace vdbfuse::mincut
