// SPDX-License-Identifier: Apache-2.0
// One level of the completion's pyramid: u on blocks of cells of that level.
#pragma once

#include <vector>

#include "surface/block_set.h"
#include "surface/cell_pyramid.h"

namespace vdbfuse {

/// Origins count cells of the level from the lowest corner of the octree's domain. 512 values a block.
struct CompletionLevel {
  BlockSet blocks;
  std::vector<float> u;     ///< 1 inside, 0 outside, the surface at ½
  std::vector<float> free;  ///< 1 where u was found by the completion
};

inline bool isInside(float u) { return u > 0.5f; }

/// Looks u up: in a level, else in the coarser one where the octree's cell is that large, else its label.
class LevelReader {
 public:
  /// Keeps references. `levels`: finest first.
  LevelReader(const CellPyramid& pyramid, const std::vector<CompletionLevel>& levels)
      : pyramid_(pyramid), levels_(levels) {}
  float at(int level, const Index3& cell) const;
  /// at() of a cube of cells from `low`, x slowest.
  void readCube(int level, const Index3& low, int side, float* values) const;

 private:
  const CellPyramid& pyramid_;
  const std::vector<CompletionLevel>& levels_;
};

/// Calls visit(cell) for the cells of a block, counted from its origin, that have another side than a
/// neighbour across a face while one of both may move.
template <class Visit>
void forEachChange(const BlockSet& blocks, const std::vector<float>& u, const std::vector<float>& may_move,
                   std::size_t block, const Visit& visit) {
  PaddedBlock<1, 1> near, movable;
  loadPadded(blocks, u.data(), block, kUnknown, near);
  loadPadded(blocks, may_move.data(), block, 0.0f, movable);
  for (int i = 0; i < static_cast<int>(kBlockSize); ++i) {
    const Index3 c = leafOffset(i);
    const bool inside = isInside(near.at(c)), moves = movable.at(c) > 0;
    for (int n = 0; n < 6; ++n) {
      const Index3 other = c + (n % 2 * 2 - 1) * Index3(Index3::Unit(n / 2));
      const float value = near.at(other);
      if (std::isnan(value) || isInside(value) == inside || !(moves || movable.at(other) > 0)) continue;
      visit(c);
      break;
    }
  }
}

/// 1 for the cells that may move and lie within `width` cells (≤ 3) of the surface where it may move.
std::vector<float> movingBand(const BlockSet& blocks, const std::vector<float>& u,
                              const std::vector<float>& may_move, int width);

}  // namespace vdbfuse
