// SPDX-License-Identifier: Apache-2.0
#include "surface/block_set.h"

#include <algorithm>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {

BlockSet::BlockSet(std::vector<Index3> origins) : origins_(std::move(origins)) {
  constexpr std::size_t kBlocksPerTask = 256;
  sortUniqueOrigins(origins_);
  neighbours_.resize(origins_.size());
  parallelFor(origins_.size(), kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      for (int n = 0; n < 27; ++n) {
        const Index3 step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
        neighbours_[b][static_cast<std::size_t>(n)] = find(origins_[b] + 8 * step);
      }
    }
  });
}

std::uint32_t BlockSet::find(const Index3& origin) const {
  const auto found = std::lower_bound(origins_.begin(), origins_.end(), origin, originBefore);
  if (found == origins_.end() || *found != origin) return kNoBlock;
  return static_cast<std::uint32_t>(found - origins_.begin());
}

}  // namespace vdbfuse
