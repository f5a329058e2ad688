// SPDX-License-Identifier: Apache-2.0
// What the cut of an octree's cells pays, in h² of ρ, and the integers that stand for it.
#pragma once

#include <functional>
#include <span>

#include "vdbfuse/octree/graph.h"

namespace vdbfuse {

/// Refers to what it is made of.
struct CutPrices {
  const Octree& octree;
  const CellTiles& tiles;
  const std::vector<float>& support;
  const std::vector<float>& sigma;
  CutOptions options;

  /// ρ · area between two nodes; `area` in h².
  double face(std::uint32_t node, std::uint32_t neighbour, double area) const;
  /// λ σ · volume for being inside.
  double volume(std::uint32_t node) const;
  /// ρ · area of the node's faces on the border of the domain.
  double border(std::uint32_t node) const;

  /// What NetworkSource asks for.
  void fill(std::uint32_t tile, TileCapacities& values) const;
  void list(const std::function<void(std::span<const NetworkEdge>)>& take) const;
};

}  // namespace vdbfuse
