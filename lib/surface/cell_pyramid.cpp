// SPDX-License-Identifier: Apache-2.0
#include "surface/cell_pyramid.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse {
namespace {

// Mean over all directions: Σ |n_i| of unit normals. λ weighs volume against faces.
constexpr double kFacesPerArea = 1.5;

}  // namespace

void CellPyramid::read(int level, const Index3& origin, PyramidBlock& out) const {
  out.solid.fill(0.0f), out.evidence.fill(0.0f), out.support.fill(0.0f);
  out.level.fill(PyramidBlock::kBeyond);
  const Index3 low = origin * (1 << level);
  if ((low.array() < 0).any() || (low.array() >= octree_.size.array()).any()) {
    out.solid.fill(beyond());
    return;
  }
  // One aligned cube in Morton order: inside one cell, or a run of consecutive cells.
  std::size_t cell = *octree_.find(octree_.origin + low);
  const std::uint64_t end = mortonCode(low) + (std::uint64_t{ScalarGrid::kLeafSize} << 3 * level);
  do {
    add(level, origin, cell, out);
  } while (++cell < octree_.cellCount() && octree_.codes[cell] < end);
  for (std::size_t i = 0; i < out.level.size(); ++i) {
    if (out.level[i] == PyramidBlock::kBeyond) out.solid[i] = beyond();
  }
}

void CellPyramid::add(int level, const Index3& origin, std::size_t cell, PyramidBlock& out) const {
  const int own = octree_.levels[cell];
  const Index3 low = (octree_.lowest(cell) - octree_.origin) / (1 << level) - origin;
  const auto evidence =
      static_cast<float>(std::clamp<double>(sigma_[cell], -energy_.max_evidence, energy_.max_evidence) *
                         energy_.lambda * octree_.frame.voxel * (1 << level) / kFacesPerArea);
  if (own < level) {
    const auto i = static_cast<std::size_t>(low.x() * 64 + low.y() * 8 + low.z());
    const float share = std::ldexp(1.0f, 3 * (own - level));
    out.solid[i] += share * solidAt(cell);
    out.evidence[i] += share * evidence;
    out.support[i] += share * support_[cell];
    out.level[i] = PyramidBlock::kMixed;
    return;
  }
  const Index3 first = low.cwiseMax(0), last = (low.array() + (1 << (own - level))).min(8).matrix();
  for (int x = first.x(); x < last.x(); ++x) {
    for (int y = first.y(); y < last.y(); ++y) {
      for (int z = first.z(); z < last.z(); ++z) {
        const auto i = static_cast<std::size_t>(x * 64 + y * 8 + z);
        out.solid[i] = solidAt(cell);
        out.evidence[i] = evidence;
        out.support[i] = support_[cell];
        out.level[i] = static_cast<std::uint8_t>(own);
      }
    }
  }
}

}  // namespace vdbfuse
