// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/octree.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "octree/morton.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

using Codes = std::vector<std::uint64_t>;

void sortUnique(Codes& codes) {
  tbb::parallel_sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
}

Codes parents(const Codes& codes) {
  Codes result;
  for (const std::uint64_t code : codes) {
    if (result.empty() || result.back() != code >> 3) result.push_back(code >> 3);
  }
  return result;
}

// All cells within one step of the given ones, corners included; `size` in cells of that level.
Codes dilated(const Codes& codes, const Index3& size) {
  Codes result = codes;
  for (int axis = 0; axis < 3; ++axis) {
    Codes next;
    next.reserve(3 * result.size());
    for (const std::uint64_t code : result) appendNeighbours(code, axis, size[axis], next);
    sortUnique(next);
    result = std::move(next);
  }
  return result;
}

Octree emptyOctree(const GridFrame& frame, const Box& domain, int max_level) {
  if (domain.isEmpty()) throw InvalidArgument("domain", "the box is empty");
  const Eigen::Vector3d low = frame.toIndex(domain.min()), high = frame.toIndex(domain.max());
  if (!((high - low).maxCoeff() < kMaxOctreeSide)) {
    throw InvalidArgument("voxel",
                          "the domain is more than " + std::to_string(kMaxOctreeSide) + " voxels long");
  }
  constexpr double kLargestIndex = 1e9;  // integer indices, with room for the octree's own slack
  if (!(low.cwiseAbs().maxCoeff() < kLargestIndex && high.cwiseAbs().maxCoeff() < kLargestIndex)) {
    throw InvalidArgument("domain", "lies more than 1e9 voxels from the origin of the grid");
  }
  Octree octree;
  octree.frame = frame;
  octree.max_level = max_level;
  const int coarsest = std::max(8, 1 << max_level);
  for (int a = 0; a < 3; ++a) {
    // The last bit of slack is shared between both ends, so that the domain stays in the middle.
    const int first = static_cast<int>(std::floor(low[a])), last = static_cast<int>(std::ceil(high[a]));
    octree.size[a] = (last - first + coarsest) / coarsest * coarsest;
    const int slack = octree.size[a] - (last - first + 1);
    octree.origin[a] = static_cast<int>(std::floor((first - slack / 2) / 8.0)) * 8;
    if (octree.origin[a] + octree.size[a] <= last) octree.size[a] += coarsest;
  }
  return octree;
}

Codes supportedVoxels(const ScalarGrid& support, float threshold, const Octree& octree) {
  Codes codes;
  for (std::size_t i = 0; i < support.leafCount(); ++i) {
    const ScalarGrid::Leaf leaf = support.leaf(i);
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      if (!(leaf.values[static_cast<std::size_t>(k)] >= threshold)) continue;
      const Index3 voxel = leaf.origin + leafOffset(k);
      if (octree.contains(voxel)) codes.push_back(mortonCode(voxel - octree.origin));
    }
  }
  sortUnique(codes);
  return codes;
}

// Codes of all children of `refined` that are not in `below` (the cells of the children's level that are
// refined themselves): the leaf cells of that level.
void appendLeafCells(const Codes& refined, const Codes& below, int level,
                     std::vector<std::pair<std::uint64_t, std::uint8_t>>& out) {
  auto next = below.begin();
  for (const std::uint64_t parent : refined) {
    for (std::uint64_t child = parent << 3; child < (parent + 1) << 3; ++child) {
      while (next != below.end() && *next < child) ++next;
      if (next != below.end() && *next == child) continue;
      out.emplace_back(child << (3 * level), static_cast<std::uint8_t>(level));
    }
  }
}

Codes coarsestCells(const Octree& octree) {
  Codes codes;
  const Index3 count = octree.size / (1 << octree.max_level);
  for (int x = 0; x < count.x(); ++x) {
    for (int y = 0; y < count.y(); ++y) {
      for (int z = 0; z < count.z(); ++z) codes.push_back(mortonCode({x, y, z}));
    }
  }
  sortUnique(codes);
  return codes;
}

}  // namespace

std::size_t Octree::firstFrom(const Index3& voxel) const {
  const std::uint64_t code = mortonCode(voxel - origin);
  return static_cast<std::size_t>(std::lower_bound(codes.begin(), codes.end(), code) - codes.begin());
}

std::optional<std::size_t> Octree::find(const Index3& voxel) const {
  if (!contains(voxel)) return std::nullopt;
  const std::uint64_t code = mortonCode(voxel - origin);
  return static_cast<std::size_t>(std::upper_bound(codes.begin(), codes.end(), code) - codes.begin()) - 1;
}

Octree buildOctree(const ScalarGrid& support, float threshold, const Box& domain,
                   const OctreeOptions& options) {
  Octree octree = emptyOctree(support.frame(), domain, options.max_level);
  // refined[l]: cells of level l that are divided. Grading: the parents of all neighbours of a divided cell
  // are divided too, hence those neighbours exist and differ by one level at the most.
  std::vector<Codes> refined(static_cast<std::size_t>(octree.max_level) + 1);
  Codes below = supportedVoxels(support, threshold, octree);
  for (std::size_t level = 1; level < refined.size(); ++level) {
    const Index3 size = octree.size / (1 << (level - (level > 1)));
    refined[level] =
        level == 1 ? dilated(parents(below), octree.size / 2) : parents(dilated(refined[level - 1], size));
  }
  std::vector<std::pair<std::uint64_t, std::uint8_t>> cells;
  for (std::size_t level = 1; level < refined.size(); ++level) {
    appendLeafCells(refined[level], refined[level - 1], static_cast<int>(level) - 1, cells);
  }
  for (const std::uint64_t code : coarsestCells(octree)) {
    const bool divided =
        octree.max_level > 0 && std::binary_search(refined.back().begin(), refined.back().end(), code);
    if (!divided)
      cells.emplace_back(code << (3 * octree.max_level), static_cast<std::uint8_t>(octree.max_level));
  }
  tbb::parallel_sort(cells.begin(), cells.end());
  octree.codes.reserve(cells.size());
  octree.levels.reserve(cells.size());
  for (const auto& [code, level] : cells) octree.codes.push_back(code), octree.levels.push_back(level);
  return octree;
}

std::vector<std::size_t> cellsByLevel(const Octree& octree) {
  std::vector<std::size_t> counts(static_cast<std::size_t>(octree.max_level) + 1);
  for (const std::uint8_t level : octree.levels) ++counts[level];
  return counts;
}

std::vector<ScalarGrid> levelGrids(const Octree& octree, const std::vector<float>& values,
                                   const std::string& name, float background) {
  std::vector<ScalarGrid> grids;
  for (int level = 0; level <= octree.max_level; ++level) {
    const double voxel = octree.frame.voxel * (1 << level);
    const Eigen::Vector3d first = octree.frame.toWorld(
        Eigen::Vector3d(octree.origin.cast<double>().array() + 0.5 * ((1 << level) - 1)));
    std::vector<Index3> origins;
    for (std::size_t c = 0; c < octree.cellCount(); ++c) {
      if (octree.levels[c] != level) continue;
      const Index3 leaf = leafOrigin(mortonPosition(octree.codes[c]) / (1 << level));
      if (origins.empty() || origins.back() != leaf) origins.push_back(leaf);
    }
    ScalarGrid grid(level == 0 ? name : name + "_level" + std::to_string(level), {voxel, first}, background,
                    std::move(origins));
    std::optional<std::size_t> leaf;
    for (std::size_t c = 0; c < octree.cellCount(); ++c) {
      if (octree.levels[c] != level) continue;
      const Index3 position = mortonPosition(octree.codes[c]) / (1 << level);
      if (!leaf || grid.leaf(*leaf).origin != leafOrigin(position))
        leaf = grid.findLeaf(leafOrigin(position));
      const Index3 local = position - leafOrigin(position);
      grid.leaf(*leaf).at(local.x(), local.y(), local.z()) = values[c];
    }
    if (grid.leafCount() > 0) grids.push_back(std::move(grid));
  }
  return grids;
}

}  // namespace vdbfuse
