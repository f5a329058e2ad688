// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/octree.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "octree/cell_set.h"
#include "octree/local_maximum.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

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

// Voxels that ask for finest cells.
CellSet supportedVoxels(const ScalarGrid& support, float threshold, const OctreeOptions& options,
                        const Octree& octree) {
  const bool only_ridges = options.ridge_radius > 0;
  const std::optional<ScalarGrid> peaks =
      only_ridges ? std::optional(localMaximum(support, options.ridge_radius)) : std::nullopt;
  constexpr int kTilesPerSide = ScalarGrid::kLeafSide / lattice::kSide;
  std::vector<CellWord> words;
  for (std::size_t i = 0; i < support.leafCount(); ++i) {
    const ScalarGrid::Leaf leaf = support.leaf(i);
    if (!octree.contains(leaf.origin)) continue;  // leaves lie inside or outside as a whole
    std::array<std::uint64_t, kTilesPerSide * kTilesPerSide * kTilesPerSide> cells{};
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const float value = leaf.values[static_cast<std::size_t>(k)];
      if (!(value >= threshold)) continue;
      if (peaks && value < options.ridge_share * peaks->leaf(i).values[static_cast<std::size_t>(k)]) continue;
      const std::uint64_t code = mortonCode(leafOffset(k));
      cells[code >> 6] |= std::uint64_t{1} << slotOf(code);
    }
    const std::uint64_t first = mortonCode(leaf.origin - octree.origin) >> 6;
    for (std::uint64_t t = 0; t < cells.size(); ++t) words.push_back({first + t, cells[t]});
  }
  return cellSet(std::move(words));
}

// Cells of every level, finest first, in one list in Morton order.
void mergeLevels(const std::vector<CellSet>& cells, Octree& octree) {
  std::size_t total = 0;
  for (const CellSet& set : cells) total += cellCount(set);
  octree.codes.clear(), octree.levels.clear();
  octree.codes.reserve(total), octree.levels.reserve(total);
  // Coarse cells are few: each is followed by the run of finer ones up to the next.
  std::vector<std::pair<std::uint64_t, std::uint8_t>> coarse;
  for (std::size_t level = 1; level < cells.size(); ++level) {
    forEachCell(cells[level], [&](std::uint64_t code) {
      coarse.emplace_back(code << 3 * level, static_cast<std::uint8_t>(level));
    });
  }
  tbb::parallel_sort(coarse.begin(), coarse.end());
  auto next = coarse.begin();
  const auto put = [&](std::uint64_t code, std::uint8_t level) {
    octree.codes.push_back(code), octree.levels.push_back(level);
  };
  forEachCell(cells.front(), [&](std::uint64_t code) {
    for (; next != coarse.end() && next->first < code; ++next) put(next->first, next->second);
    put(code, 0);
  });
  for (; next != coarse.end(); ++next) put(next->first, next->second);
}

Index3 sizeAt(const Octree& octree, std::size_t level) { return octree.size / (1 << level); }

// Cells from what is to be divided: wanted[l] are cells of level l. Grading: the parents of all neighbours of
// a divided cell are divided too, hence those neighbours exist and differ by one level at the most.
void divide(const std::vector<CellSet>& wanted, Octree& octree) {
  std::vector<CellSet> divided(wanted.size());
  for (std::size_t level = 1; level < wanted.size(); ++level) {
    divided[level] = wanted[level];
    if (level > 1)
      divided[level] =
          united(divided[level], parents(dilated(divided[level - 1], sizeAt(octree, level - 1))));
  }
  std::vector<CellSet> cells(wanted.size());
  for (std::size_t level = 0; level + 1 < wanted.size(); ++level)
    cells[level] = without(children(divided[level + 1]), divided[level]);
  cells.back() = without(allCells(sizeAt(octree, wanted.size() - 1)), divided.back());
  mergeLevels(cells, octree);
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
  std::vector<CellSet> wanted(static_cast<std::size_t>(octree.max_level) + 1);
  if (octree.max_level > 0)
    wanted[1] = dilated(parents(supportedVoxels(support, threshold, options, octree)), sizeAt(octree, 1));
  divide(wanted, octree);
  return octree;
}

Octree refined(const Octree& octree, const std::vector<std::size_t>& cells) {
  const std::size_t levels = static_cast<std::size_t>(octree.max_level) + 1;
  std::vector<std::vector<std::uint64_t>> leaves(levels), split(levels);
  for (std::size_t c = 0; c < octree.cellCount(); ++c)
    leaves[octree.levels[c]].push_back(octree.codes[c] >> 3 * octree.levels[c]);
  for (const std::size_t c : cells) {
    if (octree.levels[c] > 0) split[octree.levels[c]].push_back(octree.codes[c] >> 3 * octree.levels[c]);
  }
  std::vector<CellSet> wanted(levels);
  for (std::size_t level = 1; level < levels; ++level) {
    wanted[level] = united(parents(cellSet(leaves[level - 1])), parents(wanted[level - 1]));
    leaves[level - 1] = {};
  }
  for (std::size_t level = 1; level < levels; ++level)
    wanted[level] = united(wanted[level], cellSet(split[level]));
  Octree result;
  result.frame = octree.frame, result.origin = octree.origin, result.size = octree.size;
  result.max_level = octree.max_level;
  divide(wanted, result);
  return result;
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
