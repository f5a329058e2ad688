// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/graph.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

// Integer units per h² of ρ: the faces of a cell of 64 voxels then add up to less than 2³¹.
constexpr double kScale = 32768.0;
constexpr std::size_t kCellsPerTask = 4096;

bool touchesBorder(const Octree& octree, std::size_t cell, int axis, int direction) {
  const int low = octree.lowest(cell)[axis] - octree.origin[axis];
  return direction < 0 ? low == 0 : low + octree.side(cell) == octree.size[axis];
}

void appendFaces(const Octree& octree, std::size_t cell, std::vector<CellFace>& out) {
  const int side = octree.side(cell);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int direction : {-1, 1}) {
      if (touchesBorder(octree, cell, axis, direction)) continue;
      Index3 beyond = octree.lowest(cell);
      beyond[axis] += direction * side;
      const std::size_t other = *octree.find(beyond);
      const int difference = octree.levels[other] - octree.levels[cell];
      // Faces between unequal cells are listed by the smaller one, between equal ones by the lower one.
      if (difference < 0 || (difference == 0 && direction < 0)) continue;
      out.push_back({static_cast<std::uint32_t>(cell), static_cast<std::uint32_t>(other),
                     static_cast<std::uint8_t>(axis), static_cast<std::int8_t>(direction),
                     static_cast<std::uint16_t>(side * side)});
    }
  }
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

Network makeNetwork(const Octree& octree, const std::vector<CellFace>& faces,
                    const std::vector<float>& support, const std::vector<float>& sigma,
                    const CutOptions& options) {
  std::vector<std::int64_t> terminals(octree.cellCount());
  for (std::size_t c = 0; c < terminals.size(); ++c)
    terminals[c] = terminal(octree, c, support[c], sigma[c], options);
  return buildNetwork(std::move(terminals), [&](const auto& take) {
    std::vector<NetworkEdge> batch;
    for (std::size_t begin = 0; begin < faces.size(); begin += kCellsPerTask) {
      batch.clear();
      for (std::size_t i = begin; i < std::min(begin + kCellsPerTask, faces.size()); ++i) {
        const CellFace& face = faces[i];
        const double agreement = 0.5 * (support[face.first] + support[face.second]);
        const std::int32_t price = capacity(options.mu, agreement, face.area);
        batch.push_back({face.first, face.second, price, price});
      }
      take(batch);
    }
  });
}

CutEnergy energyOf(const Octree& octree, const std::vector<CellFace>& faces,
                   const std::vector<float>& support, const std::vector<float>& sigma,
                   const std::vector<CellLabel>& labels, const CutOptions& options) {
  const double h = octree.frame.voxel;
  CutEnergy energy;
  for (const CellFace& face : faces) {
    if (labels[face.first] == labels[face.second]) continue;
    energy.surface += face.area * std::exp(-options.mu * 0.5 * (support[face.first] + support[face.second]));
  }
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

std::vector<CellFace> cellFaces(const Octree& octree) {
  std::vector<std::vector<CellFace>> parts(chunkCount(octree.cellCount(), kCellsPerTask));
  parallelFor(octree.cellCount(), kCellsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<CellFace>& part = parts[begin / kCellsPerTask];
    for (std::size_t cell = begin; cell < end; ++cell) appendFaces(octree, cell, part);
  });
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  std::vector<CellFace> faces;
  faces.reserve(total);
  for (const auto& part : parts) faces.insert(faces.end(), part.begin(), part.end());
  return faces;
}

Labelling cutCells(const Octree& octree, const std::vector<CellFace>& faces,
                   const std::vector<float>& support, const std::vector<float>& sigma,
                   const CutOptions& options, const Progress& progress) {
  if (!(options.lambda >= 0)) throw InvalidArgument("lambda", "must not be negative");
  if (!(options.mu >= 0)) throw InvalidArgument("mu", "must not be negative");
  const Network network = makeNetwork(octree, faces, support, sigma, options);
  const MinCut cut = solve(network, {CutTies::LargestSource}, progress);
  Labelling result;
  result.certified = verify(network, cut).certified();
  result.flow = cut.flow;
  result.nodes = network.nodeCount();
  result.arcs = network.arcCount();
  result.labels.resize(octree.cellCount());
  std::transform(cut.sides.begin(), cut.sides.end(), result.labels.begin(), [](CutSide side) {
    return side == CutSide::Source ? CellLabel::Outside : CellLabel::Inside;
  });
  result.energy = energyOf(octree, faces, support, sigma, result.labels, options);
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
