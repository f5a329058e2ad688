// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "vdbfuse/octree/graph.h"

namespace vdbfuse {
namespace {

bool touchesBorder(const Octree& octree, std::size_t cell) {
  const Index3 low = octree.lowest(cell) - octree.origin;
  return (low.array() == 0).any() || (low.array() + octree.side(cell) == octree.size.array()).any();
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

Components componentsOf(const CellTiles& tiles, const std::vector<CellLabel>& labels, CellLabel label) {
  Components components(labels.size());
  forEachFace(tiles, [&](const CellFace& face) {
    if (labels[face.first] == label && labels[face.second] == label) components.join(face.first, face.second);
  });
  return components;
}

double volumeOf(const Octree& octree, std::size_t cell) {
  return std::pow(octree.side(cell) * octree.frame.voxel, 3);
}

}  // namespace

CavityReport fillUnseenCavities(const Octree& octree, const CellTiles& tiles,
                                const std::vector<Eigen::Vector3d>& sensors, Border border,
                                std::vector<CellLabel>& labels) {
  Components components = componentsOf(tiles, labels, CellLabel::Outside);
  const auto empty = [&](std::size_t cell) { return labels[cell] == CellLabel::Outside; };
  const std::vector<std::size_t> sensor_cells = cellsWithSensors(octree, sensors);
  const bool border_is_open = border != Border::Solid || sensor_cells.empty();
  std::vector<bool> open(labels.size(), false);
  const auto mark_open = [&](std::size_t cell) {
    open[components.find(static_cast<std::uint32_t>(cell))] = true;
  };
  std::for_each(sensor_cells.begin(), sensor_cells.end(), mark_open);
  for (std::size_t c = 0; border_is_open && c < labels.size(); ++c) {
    if (empty(c) && touchesBorder(octree, c)) mark_open(c);
  }
  CavityReport report;
  std::vector<std::size_t> closed;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const std::uint32_t root = components.find(static_cast<std::uint32_t>(c));
    if (!empty(c) || open[root]) continue;
    report.filled += root == c;
    report.volume += volumeOf(octree, c);
    closed.push_back(c);
  }
  for (const std::size_t c : closed) labels[c] = CellLabel::Inside;
  return report;
}

SpeckReport removeSpecks(const Octree& octree, const CellTiles& tiles, double least_volume, Border border,
                         std::vector<CellLabel>& labels) {
  Components components = componentsOf(tiles, labels, CellLabel::Inside);
  std::vector<double> volumes(labels.size(), 0.0);  // of the component, at its root
  for (std::size_t c = 0; c < labels.size(); ++c) {
    if (labels[c] != CellLabel::Inside) continue;
    double& volume = volumes[components.find(static_cast<std::uint32_t>(c))];
    volume += volumeOf(octree, c);
    if (border != Border::Outside && touchesBorder(octree, c)) volume += least_volume;
  }
  SpeckReport report;
  std::vector<std::size_t> specks;
  for (std::size_t c = 0; c < labels.size(); ++c) {
    const std::uint32_t root = components.find(static_cast<std::uint32_t>(c));
    if (labels[c] != CellLabel::Inside || volumes[root] >= least_volume) continue;
    report.removed += root == c;
    report.volume += volumeOf(octree, c);
    specks.push_back(c);
  }
  for (const std::size_t c : specks) labels[c] = CellLabel::Outside;
  return report;
}

}  // namespace vdbfuse
