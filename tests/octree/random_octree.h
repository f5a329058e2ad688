// SPDX-License-Identifier: Apache-2.0
// Small octrees around random voxels, and labels for them.
#pragma once

#include <vector>

#include "vdbfuse/base/random.h"
#include "vdbfuse/octree/graph.h"

namespace vdbfuse::test {

/// A grid "support" that holds 1 at the given voxels and 0 elsewhere.
inline ScalarGrid supportAt(const std::vector<Index3>& voxels, const GridFrame& frame = {1.0}) {
  std::vector<Index3> origins;
  for (const Index3& v : voxels) origins.push_back(leafOrigin(v));
  ScalarGrid grid("support", frame, 0.0f, origins);
  for (const Index3& v : voxels) {
    const Index3 local = v - leafOrigin(v);
    grid.leaf(*grid.findLeaf(leafOrigin(v))).at(local.x(), local.y(), local.z()) = 1.0f;
  }
  return grid;
}

struct RandomOctree {
  std::vector<Index3> voxels;
  Octree octree;
};

/// Around a few voxels of a domain of random sides up to `longest` voxels that does not begin at 0.
inline RandomOctree randomOctree(std::uint64_t seed, int longest = 40, int max_level = 4) {
  Random random(seed);
  const auto below = [&](int count) {
    return static_cast<int>(random.below(static_cast<std::uint64_t>(count)));
  };
  const Index3 low(below(30) - 15, below(30) - 15, below(30) - 15);
  const Index3 size(1 + below(longest), 1 + below(longest), 1 + below(longest));
  RandomOctree result;
  for (int i = below(4); i >= 0; --i)
    result.voxels.push_back(low + Index3(below(size.x()), below(size.y()), below(size.z())));
  const Box domain(low.cast<double>(), (low + size).cast<double>());
  result.octree = buildOctree(supportAt(result.voxels), 0.5f, domain, {max_level});
  return result;
}

inline std::vector<CellLabel> randomLabels(const Octree& octree, std::uint64_t seed, double inside = 0.5) {
  Random random(seed, 1);
  std::vector<CellLabel> labels;
  for (std::size_t c = 0; c < octree.cellCount(); ++c)
    labels.push_back(random.uniform() < inside ? CellLabel::Inside : CellLabel::Outside);
  return labels;
}

/// Every voxel of the domain's box once.
template <class Visit>
void forEachVoxel(const Octree& octree, const Visit& visit) {
  for (int x = 0; x < octree.size.x(); ++x)
    for (int y = 0; y < octree.size.y(); ++y)
      for (int z = 0; z < octree.size.z(); ++z) visit(Index3(octree.origin + Index3(x, y, z)));
}

}  // namespace vdbfuse::test
