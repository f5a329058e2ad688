// SPDX-License-Identifier: Apache-2.0
// Seeded networks for tests and benchmarks: small random ones, and grids like those that surfaces are cut
// from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vdbfuse/mincut/network.h"

namespace vdbfuse::test {

struct Instance {
  std::vector<std::int64_t> terminals;
  std::vector<NetworkEdge> edges;

  Network network() const { return buildNetwork(terminals, edges); }
};

/// What the cells of a grid know of the surface. The surface is a bumpy ball in a cube; +: outside, source.
enum class Family {
  DenseNoisy,    ///< a noisy signed value in every cell
  Carving,       ///< free space strong, the inside only a weak ballooning
  Seeds,         ///< nothing but the border of the cube and a small ball in the middle: long paths
  LowContrast,   ///< edges nearly alike, a value in one cell of twenty-five
  OneSidedScan,  ///< seen from one side; everything behind the surface is weakly inside, its edges at their
                 ///< highest
  OneSidedGap,   ///< the mirror image: what nobody saw is weakly outside
};

inline constexpr Family kFamilies[] = {Family::DenseNoisy,  Family::Carving,      Family::Seeds,
                                       Family::LowContrast, Family::OneSidedScan, Family::OneSidedGap};

std::string name(Family family);

/// A grid of side³ nodes, numbered tile by tile (8³), with edges along the axes.
/// REQUIRES: side a multiple of 8.
Instance gridInstance(Family family, std::uint32_t side, std::uint64_t seed);

struct RandomRange {
  std::uint32_t nodes = 8;
  std::uint32_t edges = 16;
  std::int64_t terminal = 10;  ///< values in [−terminal, terminal]
  std::int32_t capacity = 10;  ///< values in [0, capacity]
};

/// Edges between random nodes, parallel ones and zero capacities included; a third of the terminals is zero.
Instance randomInstance(const RandomRange& range, std::uint64_t seed);

}  // namespace vdbfuse::test
