// SPDX-License-Identifier: Apache-2.0
#include "octree/cut_prices.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

/// Integer units per h² of ρ: the faces of a cell of 64 voxels then add up to less than 2³¹.
constexpr double kScale = 32768.0;
constexpr std::size_t kEdgesPerBatch = 4096;

std::int32_t capacityOf(double price) {
  return std::max(1, static_cast<std::int32_t>(std::lround(price * kScale)));
}

}  // namespace

double CutPrices::face(std::uint32_t node, std::uint32_t neighbour, double area) const {
  const double agreement = 0.5 * (support[tiles.cells[node]] + support[tiles.cells[neighbour]]);
  return agreement == 0.0 ? area : options.cost(agreement) * area;  // most faces have none
}

double CutPrices::volume(std::uint32_t node) const {
  const double side = 1 << tiles.levels[node / lattice::kSlots];
  const double evidence =
      std::clamp<double>(sigma[tiles.cells[node]], -options.max_evidence, options.max_evidence);
  return options.lambda * octree.frame.voxel * evidence * side * side * side;
}

double CutPrices::border(std::uint32_t node) const {
  // Cells on the border of the domain are in tiles that have no neighbour there.
  if (!std::ranges::count(tiles.tiles[node / lattice::kSlots].neighbours, kNoTile)) return 0.0;
  const std::uint32_t cell = tiles.cells[node];
  const Index3 low = octree.lowest(cell) - octree.origin;
  const Index3 high = low.array() + octree.side(cell);
  const auto faces = (low.array() == 0).count() + (high.array() == octree.size.array()).count();
  if (faces == 0) return 0.0;
  const double side = octree.side(cell);
  return static_cast<double>(faces) * side * side * options.cost(support[cell]);
}

void CutPrices::fill(std::uint32_t tile, TileCapacities& values) const {
  for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {
    const std::uint32_t node = tile * lattice::kSlots + slot;
    if (tiles.cells[node] == kNoCell) continue;
    double pull = volume(node);
    if (options.border != Border::Free)
      pull += options.border == Border::Outside ? border(node) : -border(node);
    values.terminal[slot] = std::llround(pull * kScale);
  }
  const double area = faceArea(tiles.levels[tile]);
  forEachEqualFace(tiles, tile, [&](std::uint32_t node, std::uint32_t neighbour, int direction) {
    const auto axis = static_cast<std::size_t>(direction / 2);
    values.forward[axis][node % lattice::kSlots] = capacityOf(face(node, neighbour, area));
  });
  values.backward = values.forward;
}

void CutPrices::list(const std::function<void(std::span<const NetworkEdge>)>& take) const {
  std::vector<NetworkEdge> batch;
  for (std::size_t begin = 0; begin < tiles.transitions.size(); begin += kEdgesPerBatch) {
    batch.clear();
    for (std::size_t i = begin; i < std::min(begin + kEdgesPerBatch, tiles.transitions.size()); ++i) {
      const CellTransition& t = tiles.transitions[i];
      const double area = faceArea(tiles.levels[t.fine / lattice::kSlots]);
      const std::int32_t capacity = capacityOf(face(t.fine, t.coarse, area));
      batch.push_back({t.fine, t.coarse, capacity, capacity});
    }
    take(batch);
  }
}

NetworkSource cutSource(const Octree& octree, const CellTiles& tiles, const std::vector<float>& support,
                        const std::vector<float>& sigma, const CutOptions& options) {
  if (!(options.lambda >= 0)) throw InvalidArgument("lambda", "must not be negative");
  if (!(options.mu >= 0)) throw InvalidArgument("mu", "must not be negative");
  if (!(options.least_cost >= 0 && options.least_cost <= 1))
    throw InvalidArgument("least_cost", "must lie in [0, 1]");
  NetworkSource source;
  const CutPrices prices{octree, tiles, support, sigma, options};
  source.tiles = tiles.tiles;
  source.capacities = [prices](std::uint32_t tile, TileCapacities& values) { prices.fill(tile, values); };
  source.edges = [prices](const auto& take) { prices.list(take); };
  return source;
}

}  // namespace vdbfuse
