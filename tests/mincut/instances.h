// SPDX-License-Identifier: Apache-2.0
// Seeded networks for tests and benchmarks: small random ones, and grids like those that surfaces are cut
// from.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vdbfuse/mincut/network.h"
#include "vdbfuse/mincut/solve.h"

namespace vdbfuse::test {

/// A general graph.
struct Instance {
  std::vector<std::int64_t> terminals;
  std::vector<NetworkEdge> edges;

  NetworkSource source() const { return graphSource(terminals, edges); }
};

/// The same network with all edges listed; empty slots become nodes on their own.
Instance listAllEdges(const NetworkSource& source);

/// A grid of side³ cells in tiles of 4³, tiles in Morton order; edges along the axes, the same both ways.
struct GridInstance {
  std::uint32_t side = 0;
  std::vector<NetworkTile> tiles;
  std::vector<std::int64_t> terminals;                  ///< by node (64 · tile + slot)
  std::array<std::vector<std::int32_t>, 3> capacities;  ///< by node, of the edge towards +x, +y, +z

  /// On the lattice. Refers to this instance.
  NetworkSource source() const;
  Instance graph() const { return listAllEdges(source()); }
};

/// What the cells of a grid know of the surface. The surface is a bumpy ball in a cube; +: outside, source.
enum class Family {
  DenseNoisy,    ///< a noisy signed value in every cell
  Carving,       ///< free space strong, the inside only a weak ballooning
  Seeds,         ///< nothing but the border of the cube and a small ball in the middle: long paths
  LowContrast,   ///< edges nearly alike, a value in one cell of twenty-five
  OneSidedScan,  ///< seen from one side; everything behind the surface is slightly inside, its edges at their
                 ///< highest: Boykov–Kolmogorov takes twenty times its usual time
  OneSidedGap,   ///< the mirror image: what nobody saw is slightly outside
  OneSidedStrong,  ///< the same with twenty times the evidence in the shadow
};

inline constexpr Family kFamilies[] = {Family::DenseNoisy,    Family::Carving,      Family::Seeds,
                                       Family::LowContrast,   Family::OneSidedScan, Family::OneSidedGap,
                                       Family::OneSidedStrong};

std::string name(Family family);

/// REQUIRES: side a multiple of 4.
GridInstance gridInstance(Family family, std::uint32_t side, std::uint64_t seed);

/// A few tiles with holes in a row, with lattice edges, and listed edges between any nodes.
struct MixedInstance {
  std::vector<NetworkTile> tiles;
  std::vector<TileCapacities> values;
  std::vector<NetworkEdge> listed;

  NetworkSource source() const;
  /// What listAllEdges() makes of it, by coordinates in place of the lattice's own tables.
  Instance graph() const;
};
MixedInstance mixedInstance(std::uint64_t seed);

struct RandomRange {
  std::uint32_t nodes = 8;
  std::uint32_t edges = 16;
  std::int64_t terminal = 10;  ///< values in [−terminal, terminal]
  std::int32_t capacity = 10;  ///< values in [0, capacity]
};

/// Labels of nodes 0 … nodes−1.
std::vector<CutSide> sidesOf(const MinCut& cut, std::size_t nodes);

/// Edges between random nodes, parallel ones and zero capacities included; a third of the terminals is zero.
Instance randomInstance(const RandomRange& range, std::uint64_t seed);

}  // namespace vdbfuse::test
