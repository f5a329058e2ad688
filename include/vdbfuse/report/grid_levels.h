// SPDX-License-Identifier: Apache-2.0
// A field that is known finely in some places and coarsely in others, as σ is on the cells of an octree.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// A grid and, where there are any, its coarser levels NAME_level1, NAME_level2, …
class GridLevels {
 public:
  /// Refers to `grids`, which must outlive it. Throws InvalidArgument when none has that name.
  GridLevels(const std::vector<ScalarGrid>& grids, const std::string& name);
  /// These, the finest first.
  explicit GridLevels(std::vector<const ScalarGrid*> levels) : levels_(std::move(levels)) {}

  /// What a point lies in: the finest voxel with a value; not a number where there is none.
  struct Cell {
    std::size_t level = 0;  ///< 0: the finest
    Index3 voxel = Index3::Zero();
    float value = std::numeric_limits<float>::quiet_NaN();
  };
  Cell at(const Eigen::Vector3d& point) const;

  /// REQUIRES: a grid.
  const ScalarGrid& finest() const { return *levels_.front(); }

  /// Around all voxels that hold a value; empty when none does.
  Box box() const;

 private:
  std::vector<const ScalarGrid*> levels_;
};

}  // namespace vdbfuse
