// SPDX-License-Identifier: Apache-2.0
// Blocks of 8³ cells that know their neighbours: the sparse grid of loops that pass over it hundreds of times.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {

inline constexpr std::uint32_t kNoBlock = 0xffffffff;

class BlockSet {
 public:
  static constexpr std::size_t kBlockSize = ScalarGrid::kLeafSize;

  /// Origins are multiples of 8, in any order, repeats allowed.
  explicit BlockSet(std::vector<Index3> origins = {});

  std::size_t count() const { return origins_.size(); }
  /// In increasing order of (x, y, z).
  const Index3& origin(std::size_t block) const { return origins_[block]; }
  const std::vector<Index3>& origins() const { return origins_; }
  std::uint32_t find(const Index3& origin) const;
  /// The block at origin + 8·step, steps in −1 … 1; kNoBlock where there is none.
  std::uint32_t neighbour(std::size_t block, int x, int y, int z) const {
    return neighbours_[block][static_cast<std::size_t>((x + 1) * 9 + (y + 1) * 3 + z + 1)];
  }

 private:
  std::vector<Index3> origins_;
  std::vector<std::array<std::uint32_t, 27>> neighbours_;
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
};

/// The values of a block and of its neighbours; `missing` where there is no block. `values`: 512 a block.
template <int Below, int Above>
void loadPadded(const BlockSet& blocks, const float* values, std::size_t block, float missing,
                PaddedBlock<Below, Above>& out) {
  for (int bx = Below > 0 ? -1 : 0; bx <= (Above > 0 ? 1 : 0); ++bx) {
    for (int by = Below > 0 ? -1 : 0; by <= (Above > 0 ? 1 : 0); ++by) {
      for (int bz = Below > 0 ? -1 : 0; bz <= (Above > 0 ? 1 : 0); ++bz) {
        const std::uint32_t from = blocks.neighbour(block, bx, by, bz);
        const auto first = [](int b) { return b < 0 ? -Below : 8 * b; };
        const auto last = [](int b) { return b < 0 ? 0 : b == 0 ? 8 : 8 + Above; };
        for (int x = first(bx); x < last(bx); ++x) {
          for (int y = first(by); y < last(by); ++y) {
            float* to = &out.at(x, y, first(bz));
            const int count = last(bz) - first(bz);
            if (from == kNoBlock) {
              std::fill_n(to, count, missing);
            } else {
              const int place = (x & 7) * 64 + (y & 7) * 8 + (first(bz) & 7);
              std::copy_n(values + from * BlockSet::kBlockSize + place, count, to);
            }
          }
        }
      }
    }
  }
}

}  // namespace vdbfuse
