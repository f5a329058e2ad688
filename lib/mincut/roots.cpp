// SPDX-License-Identifier: Apache-2.0
#include "roots.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse::mincut {
namespace {

constexpr std::size_t kTilesPerTask = 1024;

/// So that the sum over all nodes there can be fits in 64 bits.
constexpr std::int64_t kMost = std::int64_t{1} << 30;

std::int64_t markTile(State& state, std::uint32_t t) {
  const std::int64_t* excess = &state.excess[std::size_t{t} * lattice::kSlots];
  std::uint64_t source = 0, sink = 0;
  std::int64_t sum = 0;
  for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {  // sign bits: no branches
    sink |= static_cast<std::uint64_t>(excess[slot]) >> 63 << slot;
    source |= static_cast<std::uint64_t>(-excess[slot]) >> 63 << slot;
    sum += std::clamp(excess[slot], -kMost, kMost);
  }
  state.tiles[t].source = source;
  state.tiles[t].sink = sink;
  return sum;
}

class Settler {
 public:
  Settler(State& state, std::uint32_t first, std::uint32_t last)
      : s_(state), first_(first), count_(last - first) {}

  void settleTile(std::uint32_t t) {
    Tile& tile = s_.tiles[t];
#pragma GCC unroll 6
    for (int d = 0; d < lattice::kDirections; ++d) {
      const int reverse = lattice::opposite(d);
      const std::uint64_t open = tile.source & tile.open[d];
      std::uint64_t pairs = open & lattice::stepInside(tile.sink, reverse);
      const int step = lattice::isForward(d) ? lattice::stride(d) : -lattice::stride(d);
      for (; pairs != 0; pairs &= pairs - 1) settleLattice(lowestNode(t, pairs), d, step);
      if ((open & lattice::kFace[d]) == 0 || tile.next[d] - first_ >= count_) continue;
      pairs = open & lattice::stepAcross(s_.tiles[tile.next[d]].sink, reverse);
      const auto tiles_apart = static_cast<std::int64_t>(tile.next[d]) - t;
      for (; pairs != 0; pairs &= pairs - 1)
        settleLattice(lowestNode(t, pairs), d, tiles_apart * lattice::kSlots - 3 * step);
    }
    for (std::uint64_t joined = tile.source & tile.joined; joined != 0; joined &= joined - 1)
      settleListed(lowestNode(t, joined));
  }

 private:
  void settleLattice(std::uint32_t node, int d, std::int64_t distance) {
    const auto other = static_cast<std::uint32_t>(node + distance);
    std::uint32_t& residual = s_.residual[State::latticeArc(node, d)];
    const std::uint32_t amount = pay(node, other, residual);
    s_.residual[State::latticeArc(other, lattice::opposite(d))] += amount;
    s_.tiles[tileOf(other)].open[lattice::opposite(d)] |= bitOf(other);
    if (residual == 0) s_.tiles[tileOf(node)].open[d] &= ~bitOf(node);
  }

  void settleListed(std::uint32_t node) {
    for (const std::uint32_t arc : s_.arcs(node)) {
      const std::uint32_t other = s_.heads[arc];
      if (tileOf(other) - first_ >= count_ || s_.excess[node] <= 0 || s_.excess[other] >= 0) continue;
      s_.arc_residual[s_.mates[arc]] += pay(node, other, s_.arc_residual[arc]);
    }
  }

  /// REQUIRES: excess at the node, deficit at the other.
  std::uint32_t pay(std::uint32_t node, std::uint32_t other, std::uint32_t& residual) {
    const std::int64_t wanted = std::min(s_.excess[node], -s_.excess[other]);
    const auto amount = static_cast<std::uint32_t>(std::min<std::int64_t>(wanted, residual));
    residual -= amount;
    if ((s_.excess[node] -= amount) == 0) s_.tiles[tileOf(node)].source &= ~bitOf(node);
    if ((s_.excess[other] += amount) == 0) s_.tiles[tileOf(other)].sink &= ~bitOf(other);
    return amount;
  }

  State& s_;
  std::uint32_t first_, count_;
};

}  // namespace

std::int64_t markRoots(State& state) {
  std::atomic<std::int64_t> total = 0;
  parallelFor(state.tileCount(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    std::int64_t sum = 0;
    for (std::size_t t = begin; t < end; ++t) sum += markTile(state, static_cast<std::uint32_t>(t));
    total += sum;
  });
  return total;
}

void settleNeighbours(State& state, std::uint32_t first, std::uint32_t last) {
  Settler settler(state, first, last);
  for (std::uint32_t tile = first; tile < last; ++tile) settler.settleTile(tile);
}

}  // namespace vdbfuse::mincut
