// SPDX-License-Identifier: Apache-2.0
#include "render_slice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/report/slice.h"
#include "vdbfuse/volume/leaf_index.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse::tool {
namespace {

SlicePlane parsePlane(const std::string& text) {
  const bool has_axis = text.size() > 2 && text[0] >= 'x' && text[0] <= 'z' && text[1] == '=';
  std::size_t used = 0;
  double value = 0;
  try {
    if (has_axis) value = std::stod(text.substr(2), &used);
  } catch (const std::exception&) {
  }
  if (!has_axis || used != text.size() - 2) {
    throw InvalidArgument("--slice", "expected x=VALUE, y=VALUE or z=VALUE, found '" + text + "'");
  }
  return {text[0] - 'x', value};
}

// The grid and its coarser levels, finest first.
std::vector<ScalarGrid> readLevels(const SliceRequest& request) {
  const std::vector<std::string> names = gridNames(request.file);
  std::vector<ScalarGrid> levels;
  levels.push_back(readGrid(request.file, request.grid));
  const std::string name = levels.front().name();
  for (int level = 1; level <= 12; ++level) {
    const std::string coarser = name + "_level" + std::to_string(level);
    if (std::find(names.begin(), names.end(), coarser) != names.end()) {
      levels.push_back(readGrid(request.file, coarser));
    }
  }
  return levels;
}

bool isKnown(const ScalarGrid& grid, float value) { return !std::isnan(value) && value != grid.background(); }

// Box around all voxels that hold a value.
Box boxOf(const std::vector<ScalarGrid>& levels) {
  Box box;
  for (const ScalarGrid& grid : levels) {
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
  return box;
}

double finestKnown(const std::vector<ScalarGrid>& levels, const Eigen::Vector3d& point) {
  for (const ScalarGrid& grid : levels) {
    const Index3 voxel = (grid.frame().toIndex(point).array() + 0.5).floor().cast<int>();
    const float value = grid.at(voxel);
    if (isKnown(grid, value)) return value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

Image<Rgb8> renderSlice(const SliceRequest& request) {
  const SlicePlane plane = parsePlane(request.plane);
  const std::vector<ScalarGrid> levels = readLevels(request);
  const Box box = boxOf(levels);
  if (box.isEmpty()) throw IoError(request.file, "", "a grid with values", "none");
  const auto field = [&](const Eigen::Vector3d& point) { return finestKnown(levels, point); };
  const std::string& name = levels.front().name();
  SliceOptions options;
  if (name == "rho" || name == "support" || name == "weight") options.colors = SliceColors::Sequential;
  options.low = request.low, options.high = request.high;
  return drawSlice(sampleSlice(field, box, plane, request.longest), options);
}

}  // namespace vdbfuse::tool
