// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/network.h"

#include <algorithm>
#include <string>

#include "lattice_edges.h"
#include "listed_edges.h"
#include "state.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {

using mincut::ArcCursor;
using mincut::State;
using mincut::Tile;

namespace {

constexpr std::size_t kMaxTiles = std::size_t{1} << 25;
constexpr std::uint64_t kMaxEdges = std::uint64_t{1} << 30;

[[noreturn]] void refuseTile(std::size_t tile, const std::string& what_is_wrong) {
  throw InvalidArgument("tiles", "tile " + std::to_string(tile) + " " + what_is_wrong);
}

void makeTiles(const NetworkSource& source, State& state) {
  const std::size_t count = source.tiles.size();
  if (count >= kMaxTiles) throw InvalidArgument("tiles", "2^25 tiles or more");
  state.tiles = mincut::emptyTiles(static_cast<std::uint32_t>(count));
  state.has_lattice = source.has_lattice;
  for (std::size_t t = 0; t < count; ++t) {
    state.tiles[t].nodes = source.tiles[t].nodes;
    for (int d = 0; d < lattice::kDirections; ++d) {
      const std::uint32_t next = source.has_lattice ? source.tiles[t].neighbours[d] : kNoTile;
      state.tiles[t].next[d] = next == kNoTile ? static_cast<std::uint32_t>(count) : next;
      if (next == kNoTile) continue;
      if (next >= count) refuseTile(t, "has the neighbour " + std::to_string(next) + ", which is not there");
      if (source.tiles[next].neighbours[lattice::opposite(d)] != t)
        refuseTile(t, "has the neighbour " + std::to_string(next) + ", whose neighbour it is not");
    }
  }
}

std::uint64_t addToHash(std::uint64_t hash, const NetworkEdge& edge) {
  constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15ULL;
  const std::uint64_t ends = std::uint64_t{edge.from} << 32 | edge.to;
  return ((hash ^ ends) * kOdd) ^ (hash >> 29);
}

/// Listed edges, in three calls: who has any, how many each, and which.
class RowBuilder {
 public:
  RowBuilder(const NetworkSource& source, State& state) : source_(source), state_(state) {}

  void build() {
    if (!source_.edges) return;
    forEach([this](const NetworkEdge& edge) { join(edge); });
    if (edges_ >= kMaxEdges) throw InvalidArgument("edges", "2^30 edges or more");
    std::uint32_t rows = 0;
    for (Tile& tile : state_.tiles) {
      tile.first_row = rows;
      rows += static_cast<std::uint32_t>(std::popcount(tile.joined));
    }
    state_.row_starts.assign(std::size_t{rows} + 1, 0);
    forEach([this](const NetworkEdge& edge) { count(edge); });
    for (std::size_t row = 1; row < state_.row_starts.size(); ++row)
      state_.row_starts[row] += state_.row_starts[row - 1];
    if (state_.row_starts.back() != 2 * edges_) mincut::refuseOtherEdges();
    state_.heads = mincut::Buffer<std::uint32_t>(2 * edges_);
    state_.mates = mincut::Buffer<std::uint32_t>(2 * edges_);
    state_.arc_residual = mincut::Buffer<std::uint32_t>(2 * edges_);
    place();
  }

 private:
  template <typename Visit>
  void forEach(const Visit& visit) {
    source_.edges([&](std::span<const NetworkEdge> batch) {
      for (const NetworkEdge& edge : batch) visit(edge);
    });
  }

  void join(const NetworkEdge& edge) {
    checkEdge(edge, edges_++, state_);
    hash_ = addToHash(hash_, edge);
    for (const std::uint32_t node : {edge.from, edge.to})
      state_.tiles[mincut::tileOf(node)].joined |= mincut::bitOf(node);
  }

  void count(const NetworkEdge& edge) {
    for (const std::uint32_t node : {edge.from, edge.to}) {
      if (mincut::tileOf(node) >= state_.tileCount() || !state_.isJoined(node)) mincut::refuseOtherEdges();
      ++state_.row_starts[state_.row(node) + 1];
    }
  }

  void place() {
    ArcCursor cursor(state_);
    std::uint64_t hash = 0;
    forEach([&](const NetworkEdge& edge) {
      const ArcCursor::Arcs arcs = cursor.next(edge);
      hash = addToHash(hash, edge);
      set(arcs.arc, edge.to, arcs.mate, edge.capacity);
      set(arcs.mate, edge.from, arcs.arc, edge.reverse_capacity);
    });
    cursor.finish();
    if (hash != hash_) mincut::refuseOtherEdges();
  }

  void set(std::uint32_t arc, std::uint32_t head, std::uint32_t mate, std::int32_t capacity) {
    state_.heads[arc] = head;
    state_.mates[arc] = mate;
    state_.arc_residual[arc] = static_cast<std::uint32_t>(capacity);
  }

  const NetworkSource& source_;
  State& state_;
  std::uint64_t edges_ = 0;
  std::uint64_t hash_ = 0;
};

}  // namespace

mincut::Buffer<Tile> mincut::emptyTiles(std::uint32_t count) {
  Buffer<Tile> tiles(std::size_t{count} + 1);
  std::ranges::fill(tiles, Tile{});
  tiles[count].source = ~std::uint64_t{0};
  std::ranges::fill(tiles[count].next, count);
  return tiles;
}

NetworkSource graphSource(std::vector<std::int64_t> terminals, EdgeBatches edges) {
  NetworkSource source;
  source.has_lattice = false;
  source.edges = std::move(edges);
  const std::size_t nodes = terminals.size();
  source.tiles.resize((nodes + lattice::kSlots - 1) / lattice::kSlots);
  for (std::size_t node = 0; node < nodes; ++node)
    source.tiles[node / lattice::kSlots].nodes |= std::uint64_t{1} << node % lattice::kSlots;
  source.capacities = [terminals = std::move(terminals)](std::uint32_t tile, TileCapacities& values) {
    const std::size_t begin = std::size_t{tile} * lattice::kSlots;
    const std::size_t end = std::min(begin + lattice::kSlots, terminals.size());
    for (std::size_t node = begin; node < end; ++node) values.terminal[node - begin] = terminals[node];
  };
  return source;
}

NetworkSource graphSource(std::vector<std::int64_t> terminals, std::vector<NetworkEdge> edges) {
  return graphSource(std::move(terminals),
                     EdgeBatches([edges = std::move(edges)](const auto& take) { take(edges); }));
}

Network::Network() : state_(std::make_unique<State>()) {
  state_->tiles = mincut::emptyTiles(0);
  state_->excess = mincut::Buffer<std::int64_t>(lattice::kSlots);
  std::ranges::fill(state_->excess, 0);
}
Network::~Network() = default;
Network::Network(const Network& other) : state_(std::make_unique<State>(*other.state_)) {}
Network::Network(Network&& other) noexcept = default;
Network& Network::operator=(Network other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

std::uint32_t Network::tileCount() const { return state_->tileCount(); }

std::size_t Network::nodeCount() const {
  std::size_t nodes = 0;
  for (std::uint32_t t = 0; t < tileCount(); ++t)
    nodes += static_cast<std::size_t>(std::popcount(state_->tiles[t].nodes));
  return nodes;
}

std::size_t Network::edgeCount() const {
  std::size_t edges = state_->heads.size() / 2;
  for (std::uint32_t t = 0; state_->has_lattice && t < tileCount(); ++t) {
    for (int d = 1; d < lattice::kDirections; d += 2)
      edges += static_cast<std::size_t>(std::popcount(mincut::latticeEdges(*state_, t, d)));
  }
  return edges;
}

std::int64_t Network::excess(std::uint32_t node) const { return state_->excess[node]; }

std::size_t Network::bytes() const {
  const State& s = *state_;
  return s.tiles.size() * sizeof(Tile) + s.excess.size() * sizeof(std::int64_t) +
         (s.residual.size() + s.row_starts.size() + 3 * s.heads.size()) * sizeof(std::uint32_t);
}

Network buildNetwork(const NetworkSource& source) {
  Network network;
  State& state = network.state();
  makeTiles(source, state);
  RowBuilder(source, state).build();
  mincut::fillTiles(source, state);
  return network;
}

}  // namespace vdbfuse
