// SPDX-License-Identifier: Apache-2.0
// The network a minimum cut is sought in: nodes joined by edges with a capacity each way, and one signed
// terminal value a node in place of edges to a source and a sink.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vdbfuse {

/// Joins `from` and `to`; a symmetric edge has capacity == reverse_capacity. Parallel edges add up.
struct NetworkEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::int32_t capacity = 0;  ///< price of a cut with `from` on the source side, `to` on the sink side
  std::int32_t reverse_capacity = 0;  ///< price of the opposite cut
};

/// Compressed rows, never changed once built. Every edge is two arcs, each the other's mate; the arcs that
/// leave node v are firstArc(v) … firstArc(v+1)−1. Nodes keep the caller's numbers, and an order in which
/// neighbours are near each other in memory (Morton order for cells) makes the solver faster, not different.
class Network {
 public:
  std::uint32_t nodeCount() const { return static_cast<std::uint32_t>(terminals_.size()); }
  std::uint32_t arcCount() const { return static_cast<std::uint32_t>(heads_.size()); }
  /// REQUIRES: node <= nodeCount(); firstArc(nodeCount()) == arcCount().
  std::uint32_t firstArc(std::uint32_t node) const { return first_arcs_[node]; }
  std::uint32_t head(std::uint32_t arc) const { return heads_[arc]; }
  std::uint32_t mate(std::uint32_t arc) const { return mates_[arc]; }
  std::int32_t capacity(std::uint32_t arc) const { return capacities_[arc]; }
  /// Positive: supply from the source; negative: demand of the sink. Clamped as buildNetwork() says.
  std::int64_t terminal(std::uint32_t node) const { return terminals_[node]; }
  /// Memory held, bytes.
  std::size_t bytes() const;

 private:
  friend class NetworkBuilder;
  std::vector<std::uint32_t> first_arcs_{0};
  std::vector<std::uint32_t> heads_;
  std::vector<std::uint32_t> mates_;
  std::vector<std::int32_t> capacities_;
  std::vector<std::int64_t> terminals_;
};

/// Hands over all edges, in batches of any size, by calling what it is given.
using EdgeBatches = std::function<void(const std::function<void(std::span<const NetworkEdge>)>& take)>;

/// Builds straight into the final arrays: `edges` is called twice (to count, then to place) and must hand
/// over the same edges in the same order both times, so that no list of all edges is ever needed.
///
/// `terminals` has one value a node. A cut pays terminals[v] for v on the sink side when it is positive, and
/// −terminals[v] for v on the source side when it is negative. Terminals are clamped to the capacity of the
/// edges that leave the node (enter it, for a negative one) plus one: this changes neither the value of a
/// minimum cut nor which cuts are minimum. (Without the "plus one" new ties would appear.)
///
/// Throws InvalidArgument, naming the edge, for a node out of range, an edge from a node to itself or a
/// negative capacity; for 2³¹ nodes or arcs and more; and when the two calls of `edges` differ in number.
Network buildNetwork(std::vector<std::int64_t> terminals, const EdgeBatches& edges);

/// The same from one array.
Network buildNetwork(std::vector<std::int64_t> terminals, std::span<const NetworkEdge> edges);

}  // namespace vdbfuse
