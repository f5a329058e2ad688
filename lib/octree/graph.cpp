// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/graph.h"

#include <algorithm>
#include <cmath>

#include "octree/cut_prices.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

CutEnergy energyOf(const CutPrices& prices, const std::vector<CellLabel>& labels) {
  const CellTiles& tiles = prices.tiles;
  const Border beyond = prices.options.border;
  CutEnergy energy;
  const auto add_face = [&](std::uint32_t node, std::uint32_t neighbour, double area) {
    if (labels[tiles.cells[node]] != labels[tiles.cells[neighbour]])
      energy.surface += prices.face(node, neighbour, area);
  };
  for (std::uint32_t t = 0; t < tiles.count(); ++t) {
    const double area = faceArea(tiles.levels[t]);
    forEachEqualFace(tiles, t,
                     [&](std::uint32_t node, std::uint32_t next, int) { add_face(node, next, area); });
  }
  for (const CellTransition& t : tiles.transitions)
    add_face(t.fine, t.coarse, faceArea(tiles.levels[t.fine / lattice::kSlots]));
  for (std::uint32_t node = 0; node < tiles.cells.size(); ++node) {
    if (tiles.cells[node] == kNoCell) continue;
    const bool inside = labels[tiles.cells[node]] == CellLabel::Inside;
    if (inside) energy.volume += prices.volume(node);
    const bool pays = beyond == Border::Outside ? inside : beyond == Border::Solid && !inside;
    if (pays) energy.surface += prices.border(node);
  }
  const double h = prices.octree.frame.voxel;
  energy.volume *= h * h;
  energy.surface *= h * h;
  return energy;
}

// Mean over a cube of voxels of a leaf.
float meanFrom(const ScalarGrid::Leaf& leaf, const Index3& low, int side, float threshold) {
  float sum = 0;
  for (int x = 0; x < side; ++x) {
    for (int y = 0; y < side; ++y) {
      for (int z = 0; z < side; ++z) {
        const float value = leaf.at(low.x() + x, low.y() + y, low.z() + z);
        sum += value >= threshold ? value : 0.0f;
      }
    }
  }
  return sum / static_cast<float>(side * side * side);
}

}  // namespace

const char* nameOf(Border border) {
  return border == Border::Outside ? "outside" : border == Border::Solid ? "solid" : "free";
}

Labelling cutCells(const Octree& octree, const CellTiles& tiles, const std::vector<float>& support,
                   const std::vector<float>& sigma, const CutOptions& options, const Progress& progress) {
  const NetworkSource source = cutSource(octree, tiles, support, sigma, options);
  Network network = buildNetwork(source);
  const MinCut cut = solve(network, {CutTies::LargestSource}, progress);
  Labelling result;
  result.certified = verify(source, network, cut).certified();
  result.flow = cut.flow;
  result.nodes = octree.cellCount();
  result.arcs = 2 * network.edgeCount();
  result.labels.resize(octree.cellCount());
  for (std::uint32_t node = 0; node < tiles.cells.size(); ++node) {
    if (tiles.cells[node] == kNoCell) continue;
    result.labels[tiles.cells[node]] =
        cut.side(node) == CutSide::Source ? CellLabel::Outside : CellLabel::Inside;
  }
  result.energy = energyOf(CutPrices{octree, tiles, support, sigma, options}, result.labels);
  return result;
}

std::vector<float> sampleCells(const Octree& octree, const ScalarGrid& grid, float threshold) {
  constexpr std::size_t kLeavesPerTask = 64;
  std::vector<float> values(octree.cellCount(), 0.0f);
  // Cells wider than a leaf, and what a leaf adds to them.
  std::vector<std::vector<std::pair<std::size_t, float>>> wide(chunkCount(grid.leafCount(), kLeavesPerTask));
  parallelFor(grid.leafCount(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ScalarGrid::Leaf leaf = grid.leaf(i);
      if (!octree.contains(leaf.origin)) continue;
      // A leaf is one aligned cube in Morton order: inside one cell, or a run of consecutive cells.
      std::size_t cell = *octree.find(leaf.origin);
      if (octree.levels[cell] > 3) {
        wide[begin / kLeavesPerTask].emplace_back(cell, meanFrom(leaf, Index3::Zero(), 8, threshold));
        continue;
      }
      const std::uint64_t last = mortonCode(leaf.origin - octree.origin) + ScalarGrid::kLeafSize;
      for (; cell < octree.cellCount() && octree.codes[cell] < last; ++cell) {
        const Index3 low = octree.lowest(cell) - leaf.origin;
        values[cell] = octree.levels[cell] == 0 ? leaf.at(low.x(), low.y(), low.z())
                                                : meanFrom(leaf, low, octree.side(cell), threshold);
      }
    }
  });
  for (const auto& part : wide) {
    for (const auto& [cell, mean] : part)
      values[cell] += mean / static_cast<float>(std::size_t{1} << 3 * (octree.levels[cell] - 3));
  }
  return values;
}

}  // namespace vdbfuse
