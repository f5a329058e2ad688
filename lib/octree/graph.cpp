// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/graph.h"

#include <algorithm>
#include <cmath>

#include "octree/cut_prices.h"
#include "octree/tile_faces.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kCellsPerTask = 4096;
constexpr std::size_t kTilesPerTask = 256;

CellFace faceOf(const CellTiles& tiles, std::uint32_t first, std::uint32_t second, int direction) {
  return {tiles.cells[first], tiles.cells[second], static_cast<std::uint8_t>(direction / 2),
          static_cast<std::int8_t>(lattice::isForward(direction) ? 1 : -1),
          faceArea(tiles.levels[first / lattice::kSlots])};
}

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

}  // namespace

std::vector<CellFace> cellFaces(const Octree& octree) { return cellFaces(tileCells(octree)); }

std::vector<CellFace> cellFaces(const CellTiles& tiles) {
  std::vector<std::vector<CellFace>> parts(chunkCount(tiles.count(), kTilesPerTask));
  parallelFor(tiles.count(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<CellFace>& part = parts[begin / kTilesPerTask];
    for (auto tile = static_cast<std::uint32_t>(begin); tile < end; ++tile) {
      forEachEqualFace(tiles, tile, [&](std::uint32_t node, std::uint32_t neighbour, int direction) {
        part.push_back(faceOf(tiles, node, neighbour, direction));
      });
    }
  });
  std::size_t total = tiles.transitions.size();
  for (const auto& part : parts) total += part.size();
  std::vector<CellFace> faces;
  faces.reserve(total);
  for (const auto& part : parts) faces.insert(faces.end(), part.begin(), part.end());
  for (const CellTransition& t : tiles.transitions)
    faces.push_back(faceOf(tiles, t.fine, t.coarse, t.direction));
  return faces;
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

std::vector<float> sampleFinest(const Octree& octree, const ScalarGrid& grid) {
  std::vector<float> values(octree.cellCount(), 0.0f);
  parallelFor(octree.cellCount(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
    std::optional<ScalarGrid::Leaf> leaf;
    Index3 current(1, 1, 1);  // no leaf has this origin
    for (std::size_t c = begin; c < end; ++c) {
      if (octree.levels[c] != 0) continue;
      const Index3 voxel = octree.lowest(c);
      if (leafOrigin(voxel) != current) {
        current = leafOrigin(voxel);
        const std::optional<std::size_t> found = grid.findLeaf(current);
        leaf = found ? std::optional(grid.leaf(*found)) : std::nullopt;
      }
      const Index3 local = voxel - current;
      values[c] = leaf ? leaf->at(local.x(), local.y(), local.z()) : grid.background();
    }
  });
  return values;
}

}  // namespace vdbfuse
