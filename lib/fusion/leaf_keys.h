// SPDX-License-Identifier: Apache-2.0
// Leaves as numbers in the order of ScalarGrid's leaves, for lists that are sorted and merged.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// Leaves nearer than this to the origin, counted in leaves along each axis, have a number; it is never 0.
inline constexpr int kLeafKeyReach = (1 << 20) - 1;

/// The number of a leaf by its place, counted in leaves.
inline std::uint64_t leafKey(std::int64_t x, std::int64_t y, std::int64_t z) {
  constexpr std::int64_t kOffset = std::int64_t{1} << 20;
  return static_cast<std::uint64_t>((((x + kOffset) << 21) | (y + kOffset)) << 21 | (z + kOffset));
}
inline Index3 placeOfLeaf(std::uint64_t key) {
  const auto part = [&](int shift) { return static_cast<int>(key >> shift & ((1 << 21) - 1)) - (1 << 20); };
  return {part(42), part(21), part(0)};
}

/// Collects numbers of leaves, mostly of neighbours.
class LeafKeyCollector {
 public:
  void add(std::uint64_t key) {
    std::uint64_t& recent = recent_[key * 0x9e3779b97f4a7c15ULL >> 54];
    if (recent == key) return;
    recent = key;
    found_.push_back(key);
  }
  /// All of them, sorted, once each.
  std::vector<std::uint64_t> take() {
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }

 private:
  std::vector<std::uint64_t> found_;
  std::array<std::uint64_t, 1024> recent_{};
};

}  // namespace vdbfuse
