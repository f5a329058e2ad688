// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/network.h"

#include <algorithm>
#include <limits>
#include <string>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::int32_t>::max();

[[noreturn]] void refuse(std::uint64_t edge, const std::string& what_is_wrong) {
  throw InvalidArgument("edges", "edge " + std::to_string(edge) + " " + what_is_wrong);
}

void checkEdge(const NetworkEdge& edge, std::uint64_t index, std::size_t nodes) {
  if (std::max(edge.from, edge.to) >= nodes) {
    refuse(index, "joins nodes " + std::to_string(edge.from) + " and " + std::to_string(edge.to) +
                      ", but there are " + std::to_string(nodes) + " nodes");
  }
  if (edge.from == edge.to) refuse(index, "joins node " + std::to_string(edge.from) + " to itself");
  const std::int32_t smaller = std::min(edge.capacity, edge.reverse_capacity);
  if (smaller < 0) refuse(index, "has the negative capacity " + std::to_string(smaller));
}

std::uint64_t addToHash(std::uint64_t hash, const NetworkEdge& edge) {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15ULL;
  const std::uint64_t ends = std::uint64_t{edge.from} << 32 | edge.to;
  return ((hash ^ ends) * kOdd) ^ (hash >> 29);
}

}  // namespace

/// The two passes of buildNetwork(). While counting, first_arcs_[v] is the degree of v; while placing, it is
/// one past the last free slot of v's row, and rows fill from the back, so that no array of cursors is
/// needed.
class NetworkBuilder {
 public:
  explicit NetworkBuilder(std::vector<std::int64_t> terminals) {
    if (terminals.size() > kMaxCount) throw InvalidArgument("terminals", "more than 2^31 - 1 nodes");
    network_.terminals_ = std::move(terminals);
    network_.first_arcs_.assign(network_.terminals_.size() + 1, 0);
  }

  void count(std::span<const NetworkEdge> edges) {
    for (const NetworkEdge& edge : edges) {
      checkEdge(edge, counted_++, network_.terminals_.size());
      counted_hash_ = addToHash(counted_hash_, edge);
      ++network_.first_arcs_[edge.from];
      ++network_.first_arcs_[edge.to];
    }
    if (2 * counted_ > kMaxCount) throw InvalidArgument("edges", "more than 2^30 - 1 edges");
  }

  void allocate() {
    std::uint32_t end = 0;
    for (std::uint32_t& row : network_.first_arcs_) row = end += row;
    network_.heads_.resize(end);
    network_.mates_.resize(end);
    network_.capacities_.resize(end);
  }

  void place(std::span<const NetworkEdge> edges) {
    for (const NetworkEdge& edge : edges) {
      if (placed_++ >= counted_) refuseDifference();
      checkEdge(edge, placed_ - 1, network_.terminals_.size());
      placed_hash_ = addToHash(placed_hash_, edge);
      const std::uint32_t arc = slot(edge.from);
      const std::uint32_t mate = slot(edge.to);
      set(arc, edge.to, mate, edge.capacity);
      set(mate, edge.from, arc, edge.reverse_capacity);
    }
  }

  Network finish() {
    if (placed_ != counted_ || placed_hash_ != counted_hash_) refuseDifference();
    for (std::uint32_t node = 0; node < network_.nodeCount(); ++node) clampTerminal(node);
    return std::move(network_);
  }

 private:
  [[noreturn]] static void refuseDifference() {
    throw InvalidArgument("edges", "the second call handed over other edges than the first");
  }

  std::uint32_t slot(std::uint32_t node) {
    if (network_.first_arcs_[node] == 0) refuseDifference();
    return --network_.first_arcs_[node];
  }

  void set(std::uint32_t arc, std::uint32_t head, std::uint32_t mate, std::int32_t capacity) {
    network_.heads_[arc] = head;
    network_.mates_[arc] = mate;
    network_.capacities_[arc] = capacity;
  }

  void clampTerminal(std::uint32_t node) {
    std::int64_t leaving = 1;
    std::int64_t entering = 1;
    for (std::uint32_t arc = network_.firstArc(node); arc < network_.firstArc(node + 1); ++arc) {
      leaving += network_.capacity(arc);
      entering += network_.capacity(network_.mate(arc));
    }
    std::int64_t& terminal = network_.terminals_[node];
    terminal = std::clamp(terminal, -entering, leaving);
  }

  Network network_;
  std::uint64_t counted_ = 0;
  std::uint64_t placed_ = 0;
  std::uint64_t counted_hash_ = 0;
  std::uint64_t placed_hash_ = 0;
};

std::size_t Network::bytes() const {
  return first_arcs_.size() * sizeof(first_arcs_[0]) + heads_.size() * sizeof(heads_[0]) +
         mates_.size() * sizeof(mates_[0]) + capacities_.size() * sizeof(capacities_[0]) +
         terminals_.size() * sizeof(terminals_[0]);
}

Network buildNetwork(std::vector<std::int64_t> terminals, const EdgeBatches& edges) {
  NetworkBuilder builder(std::move(terminals));
  edges([&](std::span<const NetworkEdge> batch) { builder.count(batch); });
  builder.allocate();
  edges([&](std::span<const NetworkEdge> batch) { builder.place(batch); });
  return builder.finish();
}

Network buildNetwork(std::vector<std::int64_t> terminals, std::span<const NetworkEdge> edges) {
  return buildNetwork(std::move(terminals), [edges](const auto& take) { take(edges); });
}

}  // namespace vdbfuse
