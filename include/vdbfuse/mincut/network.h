// SPDX-License-Identifier: Apache-2.0
// The network a minimum cut is sought in: nodes joined by edges with a capacity each way, and one signed
// terminal value a node in place of edges to a source and a sink.
//
// Nodes come in tiles of 64. On a lattice (cells of a grid, or of one level of an octree) a tile is a block
// of 4³ cells whose edges need no list: they follow from the position (lattice.h). All other edges, between
// the levels of an octree or in a general graph, are listed. Both kinds may meet in one network.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "vdbfuse/mincut/lattice.h"

namespace vdbfuse {

namespace mincut {
struct State;
}

/// A node is called 64 · tile + slot.
inline constexpr std::uint32_t kNoTile = 0xffffffff;

struct NetworkTile {
  std::uint64_t nodes = 0;  ///< bit s: there is a node in slot s
  /// The tiles beyond the six faces, or kNoTile. Only read when the network has a lattice.
  std::array<std::uint32_t, lattice::kDirections> neighbours = {kNoTile, kNoTile, kNoTile,
                                                                kNoTile, kNoTile, kNoTile};
};

/// What one tile brings. Values of slots without a node, and of edges to such a slot, are ignored.
struct TileCapacities {
  /// Price of the node on the sink side when positive; minus the price on the source side when negative.
  std::array<std::int64_t, lattice::kSlots> terminal{};
  /// Of the edges towards +x, +y, +z: price of a cut with this node on the source side, the next on the sink
  /// side.
  std::array<std::array<std::int32_t, lattice::kSlots>, 3> forward{};
  /// Price of the opposite cut.
  std::array<std::array<std::int32_t, lattice::kSlots>, 3> backward{};
};

/// A listed edge. Parallel edges add up.
struct NetworkEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::int32_t capacity = 0;  ///< price of a cut with `from` on the source side, `to` on the sink side
  std::int32_t reverse_capacity = 0;  ///< price of the opposite cut
};

/// Hands over all listed edges, in batches of any size, by calling what it is given.
using EdgeBatches = std::function<void(const std::function<void(std::span<const NetworkEdge>)>& take)>;

/// A network as its maker knows it. It is asked, never copied: everything that is built, checked or updated
/// asks again, and must be told the same.
struct NetworkSource {
  std::vector<NetworkTile> tiles;
  /// Fills in one tile; called from several threads. The values come in zeroed.
  std::function<void(std::uint32_t tile, TileCapacities& values)> capacities;
  bool has_lattice = true;  ///< false: `forward` and `backward` are not read, and take no memory
  EdgeBatches edges;        ///< may be empty; called several times: same edges, same order
};

/// A general graph: nodes 0 … terminals.size()−1, all edges listed. Keeps its arguments.
NetworkSource graphSource(std::vector<std::int64_t> terminals, EdgeBatches edges);
NetworkSource graphSource(std::vector<std::int64_t> terminals, std::vector<NetworkEdge> edges);

/// Terminals reach from −kLargestTerminal to kLargestTerminal. They are kept as they are: 64 bits hold them,
/// so that none has to be clamped (which, done carelessly, makes new ties).
inline constexpr std::int64_t kLargestTerminal = std::int64_t{1} << 56;

/// A network with the flow that it carries: none at first, then what solve() leaves in it. Takes about 34
/// bytes a lattice slot, and 12 bytes an arc (two arcs a listed edge) and 4 bytes a node with listed edges.
class Network {
 public:
  Network();
  ~Network();
  Network(const Network& other);
  Network(Network&& other) noexcept;
  Network& operator=(Network other) noexcept;

  std::uint32_t tileCount() const;
  /// Slots in use: the true number of nodes.
  std::size_t nodeCount() const;
  /// Lattice edges whose nodes both exist, and listed ones.
  std::size_t edgeCount() const;
  /// Terminal plus what flows in minus what flows out. REQUIRES: node < 64 · tileCount().
  std::int64_t excess(std::uint32_t node) const;
  /// Memory held, bytes.
  std::size_t bytes() const;

  mincut::State& state() { return *state_; }
  const mincut::State& state() const { return *state_; }

 private:
  std::unique_ptr<mincut::State> state_;
};

/// Builds straight into the final arrays, tiles on several threads: no list of all edges is ever needed.
///
/// Throws InvalidArgument, naming the tile or edge, for a neighbour that is not there or does not know of it,
/// a negative capacity, a terminal out of range, an edge that joins a node to itself or to an empty slot; for
/// 2²⁵ tiles or 2³⁰ listed edges and more; and when `edges` hands over other edges than the time before.
Network buildNetwork(const NetworkSource& source);

/// Lets `network` have the capacities of `after` in place of those of `before`, and keeps the flow as far as
/// they allow it; a solve() after it finds the cut of `after`, and is quick if little has changed. Tiles that
/// are not in `changed` must be the same in both sources; listed edges may all differ in capacity. Both must
/// have the nodes and the edges that the network was built with. Throws as buildNetwork() does; the network
/// is to be thrown away then.
void updateNetwork(Network& network, const NetworkSource& before, const NetworkSource& after,
                   std::span<const std::uint32_t> changed);

}  // namespace vdbfuse
