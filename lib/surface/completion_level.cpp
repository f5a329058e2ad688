// SPDX-License-Identifier: Apache-2.0
#include "surface/completion_level.h"

#include <map>

namespace vdbfuse {
namespace {

constexpr int kWidest = 3;
using Patch = PaddedBlock<kWidest, kWidest>;

// The largest value within `width` cells along an axis; the axes done before are valid in the block only.
void widen(int axis, int width, Patch& patch) {
  const Patch in = patch;
  const Index3 step = Index3::Unit(axis);
  Index3 low = Index3::Constant(-kWidest), high = Index3::Constant(8 + kWidest);
  for (int a = 0; a <= axis; ++a) low[a] = 0, high[a] = 8;
  for (int x = low.x(); x < high.x(); ++x) {
    for (int y = low.y(); y < high.y(); ++y) {
      for (int z = low.z(); z < high.z(); ++z) {
        float largest = 0;
        for (int k = -width; k <= width; ++k) largest = std::max(largest, in.at(Index3(x, y, z) + k * step));
        patch.at(x, y, z) = largest;
      }
    }
  }
}

}  // namespace

float LevelReader::at(int level, const Index3& cell) const {
  const CompletionLevel& own = levels_[static_cast<std::size_t>(level)];
  if (const std::uint32_t b = own.blocks.find(leafOrigin(cell)); b != kNoBlock)
    return own.u[b * kBlockSize + leafPlace(cell)];
  const Octree& octree = pyramid_.octree();
  const Index3 middle = cell * (1 << level) + Index3::Constant(level > 0 ? 1 << (level - 1) : 0);
  const std::optional<std::size_t> found = octree.find(octree.origin + middle);
  if (!found) return pyramid_.beyond();
  const bool is_coarser = octree.levels[*found] > level && level + 1 < static_cast<int>(levels_.size());
  if (!is_coarser) return pyramid_.solidAt(*found);
  return at(level + 1, Index3(cell.x() >> 1, cell.y() >> 1, cell.z() >> 1));
}

void LevelReader::readCube(int level, const Index3& low, int side, float* values) const {
  const CompletionLevel& own = levels_[static_cast<std::size_t>(level)];
  std::map<std::array<int, 3>, std::uint32_t> blocks;  // a few
  for (int k = 0; k < side * side * side; ++k) {
    const Index3 cell = low + Index3(k / (side * side), k / side % side, k % side);
    const Index3 origin = leafOrigin(cell);
    const auto [entry, is_new] = blocks.try_emplace({origin.x(), origin.y(), origin.z()}, kNoBlock);
    if (is_new) entry->second = own.blocks.find(origin);
    values[k] =
        entry->second != kNoBlock ? own.u[entry->second * kBlockSize + leafPlace(cell)] : at(level, cell);
  }
}

std::vector<float> movingBand(const BlockSet& blocks, const std::vector<float>& u,
                              const std::vector<float>& may_move, int width) {
  std::vector<float> marks(may_move.size(), 0.0f), free(may_move.size(), 0.0f);
  forEachBlock(blocks.count(), [&](std::size_t b) {
    forEachChange(blocks, u, may_move, b,
                  [&](const Index3& cell) { marks[b * kBlockSize + leafPlace(cell)] = 1; });
  });
  forEachBlock(blocks.count(), [&](std::size_t b) {
    Patch near;
    loadPadded(blocks, marks.data(), b, 0.0f, near);
    if (std::none_of(near.values.begin(), near.values.end(), [](float m) { return m > 0; })) return;
    for (int axis = 0; axis < 3; ++axis) widen(axis, width, near);
    for (std::size_t i = 0; i < kBlockSize; ++i)
      free[b * kBlockSize + i] = may_move[b * kBlockSize + i] * near.at(leafOffset(static_cast<int>(i)));
  });
  return free;
}

}  // namespace vdbfuse
