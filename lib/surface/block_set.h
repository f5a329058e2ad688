// SPDX-License-Identifier: Apache-2.0
// Blocks of 8³ cells that know their neighbours: the sparse grid of loops that pass over it hundreds of
// times. Values lie in plain arrays, 512 a block, in the order of leafOffset().
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {

inline constexpr std::uint32_t kNoBlock = 0xffffffff;
inline constexpr std::size_t kBlockSize = ScalarGrid::kLeafSize;

class BlockSet {
 public:
  /// Origins are multiples of 8, in any order, repeats allowed.
  explicit BlockSet(std::vector<Index3> origins = {});

  std::size_t count() const { return origins_.size(); }
  /// Values of arrays that hold 512 a block.
  std::size_t valueCount() const { return count() * kBlockSize; }
  /// In increasing order of (x, y, z).
  const Index3& origin(std::size_t block) const { return origins_[block]; }
  const std::vector<Index3>& origins() const { return origins_; }
  std::uint32_t find(const Index3& origin) const;
  /// The block at origin + 8·step, steps in −1 … 1; kNoBlock where there is none.
  std::uint32_t neighbour(std::size_t block, int x, int y, int z) const {
    return neighbours_[block][static_cast<std::size_t>((x + 1) * 9 + (y + 1) * 3 + z + 1)];
  }
  /// The value beside a value of arrays that hold 512 a block, steps in −1 … 1; nothing outside the blocks.
  std::optional<std::size_t> neighbourOf(std::size_t value, const Index3& step) const {
    const Index3 v = leafOffset(static_cast<int>(value % kBlockSize)) + step;
    const std::uint32_t b = neighbour(value / kBlockSize, v.x() >> 3, v.y() >> 3, v.z() >> 3);
    if (b == kNoBlock) return std::nullopt;
    return b * kBlockSize + leafPlace(v);
  }

 private:
  std::vector<Index3> origins_;
  std::vector<std::array<std::uint32_t, 27>> neighbours_;
};

/// Calls visit(b) for the numbers 0 … count − 1 of blocks, in parallel.
template <class Visit>
void forEachBlock(std::size_t count, const Visit& visit) {
  constexpr std::size_t kBlocksPerTask = 16;
  parallelFor(count, kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) visit(b);
  });
}

/// Lists of origins made block by block, as one list.
std::vector<Index3> joined(const std::vector<std::vector<Index3>>& parts);

/// Appends the origins of all blocks that meet the cells low … high.
void appendBlocks(const Index3& low, const Index3& high, std::vector<Index3>& origins);

/// Values at the voxels of a grid; origins of blocks in its index coordinates.
struct BlockField {
  GridFrame frame;
  BlockSet blocks;
  std::vector<float> values;

  float* block(std::size_t b) { return &values[b * kBlockSize]; }
  const float* block(std::size_t b) const { return &values[b * kBlockSize]; }
};

/// A block's values with a margin of `Below` cells before and `Above` after it along each axis.
template <int Below, int Above>
struct PaddedBlock {
  static constexpr int kSide = 8 + Below + Above;
  std::array<float, static_cast<std::size_t>(kSide* kSide* kSide)> values;

  static constexpr std::size_t place(int x, int y, int z) {
    return static_cast<std::size_t>(((x + Below) * kSide + y + Below) * kSide + z + Below);
  }
  float& at(int x, int y, int z) { return values[place(x, y, z)]; }
  float at(int x, int y, int z) const { return values[place(x, y, z)]; }
  float at(const Index3& cell) const { return at(cell.x(), cell.y(), cell.z()); }
};

/// Loads a block's values and those of its neighbours from `values`; `missing` where there is no block.
template <int Below, int Above>
void loadPadded(const BlockSet& blocks, const float* values, std::size_t block, float missing,
                PaddedBlock<Below, Above>& out) {
  const auto step = [](int i) { return i < 0 ? -1 : i < 8 ? 0 : 1; };
  for (int x = -Below; x < 8 + Above; ++x) {
    for (int y = -Below; y < 8 + Above; ++y) {
      float* row = &out.at(x, y, 0);
      const std::size_t place = leafPlace({x, y, 0});
      const auto from = [&](int z) -> const float* {
        const std::uint32_t b = blocks.neighbour(block, step(x), step(y), z);
        return b == kNoBlock ? nullptr : values + b * kBlockSize + place;
      };
      if constexpr (Below > 0) {
        const float* below = from(-1);
        for (int z = -Below; z < 0; ++z) row[z] = below ? below[8 + z] : missing;
      }
      const float* own = from(0);
      for (int z = 0; z < 8; ++z) row[z] = own ? own[z] : missing;
      if constexpr (Above > 0) {
        const float* above = from(1);
        for (int z = 0; z < Above; ++z) row[8 + z] = above ? above[z] : missing;
      }
    }
  }
}

}  // namespace vdbfuse
