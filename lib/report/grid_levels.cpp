// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/grid_levels.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr int kMostLevels = 12;

const ScalarGrid* find(const std::vector<ScalarGrid>& grids, const std::string& name) {
  const auto found =
      std::find_if(grids.begin(), grids.end(), [&](const ScalarGrid& grid) { return grid.name() == name; });
  return found == grids.end() ? nullptr : &*found;
}

bool isKnown(const ScalarGrid& grid, float value) { return !std::isnan(value) && value != grid.background(); }

void extendBy(const ScalarGrid& grid, Box& box) {
  for (std::size_t i = 0; i < grid.leafCount(); ++i) {
    const ScalarGrid::Leaf leaf = grid.leaf(i);
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      if (!isKnown(grid, leaf.values[static_cast<std::size_t>(k)])) continue;
      const Eigen::Vector3d voxel = (leaf.origin + leafOffset(k)).cast<double>();
      box.extend(grid.frame().toWorld(Eigen::Vector3d(voxel.array() - 0.5)));
      box.extend(grid.frame().toWorld(Eigen::Vector3d(voxel.array() + 0.5)));
    }
  }
}

}  // namespace

GridLevels::GridLevels(const std::vector<ScalarGrid>& grids, const std::string& name) {
  const ScalarGrid* finest = find(grids, name);
  if (finest == nullptr) throw InvalidArgument("grid", "there is none called '" + name + "'");
  levels_.push_back(finest);
  for (int level = 1; level <= kMostLevels; ++level)
    if (const ScalarGrid* coarser = find(grids, name + "_level" + std::to_string(level)))
      levels_.push_back(coarser);
}

GridLevels::Cell GridLevels::at(const Eigen::Vector3d& point) const {
  Cell cell;
  for (; cell.level < levels_.size(); ++cell.level) {
    const ScalarGrid& grid = *levels_[cell.level];
    cell.voxel = (grid.frame().toIndex(point).array() + 0.5).floor().cast<int>();
    const float value = grid.at(cell.voxel);
    if (!isKnown(grid, value)) continue;
    cell.value = value;
    break;
  }
  return cell;
}

Box GridLevels::box() const {
  Box box;
  for (const ScalarGrid* grid : levels_) extendBy(*grid, box);
  return box;
}

}  // namespace vdbfuse
