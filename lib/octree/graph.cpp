// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/graph.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

/// Integer units per h² of ρ: the faces of a cell of 64 voxels then add up to less than 2³¹.
constexpr double kScale = 32768.0;
constexpr std::size_t kCellsPerTask = 4096;
constexpr std::size_t kTilesPerTask = 256;

bool touchesBorder(const Octree& octree, std::size_t cell, int axis, int direction) {
  const int low = octree.lowest(cell)[axis] - octree.origin[axis];
  return direction < 0 ? low == 0 : low + octree.side(cell) == octree.size[axis];
}

/// Calls visit(node, neighbour, direction) for the faces between cells of a tile and their equals in +x, +y,
/// +z.
template <typename Visit>
void forEachEqualFace(const CellTiles& tiles, std::uint32_t t, const Visit& visit) {
  const NetworkTile& tile = tiles.tiles[t];
  for (int d = 1; d < lattice::kDirections; d += 2) {
    const int back = lattice::opposite(d);
    const std::uint32_t next = tile.neighbours[static_cast<std::size_t>(d)];
    const std::uint64_t beyond = next == kNoTile ? 0 : tiles.tiles[next].nodes;
    std::uint64_t slots =
        tile.nodes & (lattice::stepInside(tile.nodes, back) | lattice::stepAcross(beyond, back));
    for (; slots != 0; slots &= slots - 1) {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(slots));
      const bool leaves = (lattice::leavingDirections(slot) >> d & 1) != 0;
      visit(t * lattice::kSlots + slot,
            (leaves ? next : t) * lattice::kSlots + lattice::neighbourSlot(slot, d), d);
    }
  }
}

/// Finest faces of a cell of this level.
std::uint16_t faceArea(std::uint8_t level) { return static_cast<std::uint16_t>(1u << 2 * level); }

CellFace faceOf(const CellTiles& tiles, std::uint32_t first, std::uint32_t second, int direction) {
  return {tiles.cells[first], tiles.cells[second], static_cast<std::uint8_t>(direction / 2),
          static_cast<std::int8_t>(lattice::isForward(direction) ? 1 : -1),
          faceArea(tiles.levels[first / lattice::kSlots])};
}

// Faces of a cell on the border of the domain, in h².
double borderArea(const Octree& octree, std::size_t cell) {
  int faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    faces += touchesBorder(octree, cell, axis, -1) + touchesBorder(octree, cell, axis, 1);
  }
  return static_cast<double>(faces) * octree.side(cell) * octree.side(cell);
}

std::int32_t capacity(double mu, double agreement, double area) {
  return std::max(1, static_cast<std::int32_t>(std::lround(std::exp(-mu * agreement) * area * kScale)));
}

// Signed terminal value: positive pulls outside.
std::int64_t terminal(const Octree& octree, std::size_t cell, double support, double sigma,
                      const CutOptions& options) {
  const double evidence = std::clamp(sigma, -options.max_evidence, options.max_evidence);
  double value = options.lambda * octree.frame.voxel * evidence * std::pow(octree.side(cell), 3);
  const double border = borderArea(octree, cell) * std::exp(-options.mu * support);
  if (options.border == Border::Outside) value += border;
  if (options.border == Border::Solid) value -= border;
  return std::llround(value * kScale);
}

/// What the cut's network is made of, shared by all that ask for it.
struct Prices {
  const Octree& octree;
  const CellTiles& tiles;
  const std::vector<float>& support;
  const std::vector<float>& sigma;
  CutOptions options;

  std::int32_t of(std::uint32_t node, std::uint32_t neighbour, double area) const {
    const double agreement = 0.5 * (support[tiles.cells[node]] + support[tiles.cells[neighbour]]);
    return capacity(options.mu, agreement, area);
  }

  void fill(std::uint32_t tile, TileCapacities& values) const {
    for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {
      const std::uint32_t cell = tiles.cells[std::size_t{tile} * lattice::kSlots + slot];
      if (cell != kNoCell)
        values.terminal[slot] = terminal(octree, cell, support[cell], sigma[cell], options);
    }
    const double area = faceArea(tiles.levels[tile]);
    forEachEqualFace(tiles, tile, [&](std::uint32_t node, std::uint32_t neighbour, int direction) {
      const auto axis = static_cast<std::size_t>(direction / 2);
      values.forward[axis][node % lattice::kSlots] = of(node, neighbour, area);
    });
    values.backward = values.forward;
  }

  void list(const std::function<void(std::span<const NetworkEdge>)>& take) const {
    std::vector<NetworkEdge> batch;
    for (std::size_t begin = 0; begin < tiles.transitions.size(); begin += kCellsPerTask) {
      batch.clear();
      for (std::size_t i = begin; i < std::min(begin + kCellsPerTask, tiles.transitions.size()); ++i) {
        const CellTransition& t = tiles.transitions[i];
        const std::int32_t price = of(t.fine, t.coarse, faceArea(tiles.levels[t.fine / lattice::kSlots]));
        batch.push_back({t.fine, t.coarse, price, price});
      }
      take(batch);
    }
  }
};

CutEnergy energyOf(const Prices& prices, const std::vector<CellLabel>& labels) {
  const auto& [octree, tiles, support, sigma, options] = prices;
  const double h = octree.frame.voxel;
  CutEnergy energy;
  const auto addFace = [&](std::uint32_t node, std::uint32_t neighbour, double area) {
    const std::uint32_t a = tiles.cells[node], b = tiles.cells[neighbour];
    if (labels[a] != labels[b])
      energy.surface += area * std::exp(-options.mu * 0.5 * (support[a] + support[b]));
  };
  for (std::uint32_t t = 0; t < tiles.count(); ++t) {
    const double area = faceArea(tiles.levels[t]);
    forEachEqualFace(tiles, t,
                     [&](std::uint32_t node, std::uint32_t next, int) { addFace(node, next, area); });
  }
  for (const CellTransition& t : tiles.transitions)
    addFace(t.fine, t.coarse, faceArea(tiles.levels[t.fine / lattice::kSlots]));
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const bool inside = labels[c] == CellLabel::Inside;
    if (inside) {
      const double evidence = std::clamp<double>(sigma[c], -options.max_evidence, options.max_evidence);
      energy.volume += options.lambda * evidence * std::pow(octree.side(c) * h, 3);
    }
    const bool pays = options.border == Border::Outside ? inside : options.border == Border::Solid && !inside;
    if (pays) energy.surface += borderArea(octree, c) * std::exp(-options.mu * support[c]);
  }
  energy.surface *= h * h;
  return energy;
}

// Disjoint sets of cells, with path halving.
class Components {
 public:
  explicit Components(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t cell) {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::vector<std::size_t> cellsWithSensors(const Octree& octree, const std::vector<Eigen::Vector3d>& sensors) {
  std::vector<std::size_t> cells;
  for (const Eigen::Vector3d& sensor : sensors) {
    const Eigen::Vector3d index = octree.frame.toIndex(sensor);
    if (!(index.cwiseAbs().maxCoeff() < 1e9)) continue;
    if (const auto cell = octree.find((index.array() + 0.5).floor().cast<int>().matrix()))
      cells.push_back(*cell);
  }
  return cells;
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

NetworkSource cutSource(const Octree& octree, const CellTiles& tiles, const std::vector<float>& support,
                        const std::vector<float>& sigma, const CutOptions& options) {
  if (!(options.lambda >= 0)) throw InvalidArgument("lambda", "must not be negative");
  if (!(options.mu >= 0)) throw InvalidArgument("mu", "must not be negative");
  NetworkSource source;
  const Prices prices{octree, tiles, support, sigma, options};
  source.tiles = tiles.tiles;
  source.capacities = [prices](std::uint32_t tile, TileCapacities& values) { prices.fill(tile, values); };
  source.edges = [prices](const auto& take) { prices.list(take); };
  return source;
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
  result.energy = energyOf({octree, tiles, support, sigma, options}, result.labels);
  return result;
}

CavityReport fillUnseenCavities(const Octree& octree, const std::vector<CellFace>& faces,
                                const std::vector<Eigen::Vector3d>& sensors, Border border,
                                std::vector<CellLabel>& labels) {
  Components components(labels.size());
  const auto empty = [&](std::size_t cell) { return labels[cell] == CellLabel::Outside; };
  for (const CellFace& face : faces) {
    if (empty(face.first) && empty(face.second)) components.join(face.first, face.second);
  }
  const std::vector<std::size_t> sensor_cells = cellsWithSensors(octree, sensors);
  const bool border_is_open = border != Border::Solid || sensor_cells.empty();
  std::vector<bool> open(labels.size(), false);
  const auto markOpen = [&](std::size_t cell) {
    open[components.find(static_cast<std::uint32_t>(cell))] = true;
  };
  std::for_each(sensor_cells.begin(), sensor_cells.end(), markOpen);
  for (std::size_t c = 0; border_is_open && c < labels.size(); ++c) {
    if (empty(c) && borderArea(octree, c) > 0) markOpen(c);
  }
  CavityReport report;
  std::vector<std::size_t> closed;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const std::uint32_t root = components.find(static_cast<std::uint32_t>(c));
    if (!empty(c) || open[root]) continue;
    report.filled += root == c;
    report.volume += std::pow(octree.side(c) * octree.frame.voxel, 3);
    closed.push_back(c);
  }
  for (const std::size_t c : closed) labels[c] = CellLabel::Inside;
  return report;
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
