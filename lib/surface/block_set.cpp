// SPDX-License-Identifier: Apache-2.0
#include "surface/block_set.h"

namespace vdbfuse {

BlockSet::BlockSet(std::vector<Index3> origins) : origins_(std::move(origins)) {
  sortUniqueOrigins(origins_);
  neighbours_.resize(origins_.size());
  forEachBlock(origins_.size(), [&](std::size_t b) {
    for (int n = 0; n < 27; ++n) {
      const Index3 step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
      neighbours_[b][static_cast<std::size_t>(n)] = find(origins_[b] + 8 * step);
    }
  });
}

std::uint32_t BlockSet::find(const Index3& origin) const {
  const auto found = std::lower_bound(origins_.begin(), origins_.end(), origin, originBefore);
  if (found == origins_.end() || *found != origin) return kNoBlock;
  return static_cast<std::uint32_t>(found - origins_.begin());
}

std::vector<Index3> joined(const std::vector<std::vector<Index3>>& parts) {
  std::vector<Index3> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  sortUniqueOrigins(all);
  return all;
}

void appendBlocks(const Index3& low, const Index3& high, std::vector<Index3>& origins) {
  const Index3 first = leafOrigin(low), last = leafOrigin(high);
  for (int x = first.x(); x <= last.x(); x += 8) {
    for (int y = first.y(); y <= last.y(); y += 8) {
      for (int z = first.z(); z <= last.z(); z += 8) origins.emplace_back(x, y, z);
    }
  }
}

}  // namespace vdbfuse
