// SPDX-License-Identifier: Apache-2.0
#include "surface/settle.h"

#include <algorithm>
#include <cmath>

#include "surface/simple_point.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kBlocksPerTask = 64;
constexpr int kPasses = 4;  // a surface that is a voxel off needs one or two

std::vector<std::size_t> contradictions(const std::vector<float>& field, const std::vector<float>& may_change,
                                        const BlockField& sides) {
  std::vector<std::vector<std::size_t>> parts(chunkCount(sides.blocks.count(), kBlocksPerTask));
  parallelFor(sides.blocks.count(), kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin * kBlockSize; v < end * kBlockSize; ++v) {
      if (may_change[v] > 0 && field[v] * sides.values[v] < 0) parts[begin / kBlocksPerTask].push_back(v);
    }
  });
  std::vector<std::size_t> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end(),
                   [&](std::size_t a, std::size_t b) { return std::abs(field[a]) > std::abs(field[b]); });
  return all;
}

// False next to blocks that are not there.
bool canChange(const BlockField& sides, std::size_t voxel) {
  Neighbourhood inside = 0;
  for (int dx = -1; dx <= 1; ++dx) {
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dz = -1; dz <= 1; ++dz) {
        const std::optional<std::size_t> next = sides.blocks.neighbourOf(voxel, {dx, dy, dz});
        if (!next) return false;
        if (sides.values[*next] < 0) inside |= neighbourBit(dx, dy, dz);
      }
    }
  }
  return isSimple(inside);
}

}  // namespace

std::size_t settleSides(const std::vector<float>& field, const std::vector<float>& may_change,
                        BlockField& sides) {
  std::vector<std::size_t> open = contradictions(field, may_change, sides);
  const std::size_t count = open.size();
  for (int pass = 0; pass < kPasses && !open.empty(); ++pass) {
    const auto settled = [&](std::size_t voxel) {
      if (!canChange(sides, voxel)) return false;
      sides.values[voxel] = -sides.values[voxel];
      return true;
    };
    std::vector<std::size_t> left;
    std::copy_if(open.begin(), open.end(), std::back_inserter(left),
                 [&](std::size_t voxel) { return !settled(voxel); });
    if (left.size() == open.size()) break;
    open = std::move(left);
  }
  return count - open.size();
}

}  // namespace vdbfuse
