// SPDX-License-Identifier: Apache-2.0
// Arithmetic of 8³ leaves that every loop over them shares.
#pragma once

#include <algorithm>
#include <vector>

#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// Place of value `i` of a ScalarGrid::Leaf, counted from the leaf's origin.
inline Index3 leafOffset(int i) { return {i >> 6, i >> 3 & 7, i & 7}; }

/// Which value of its leaf a voxel is.
inline std::size_t leafPlace(const Index3& voxel) {
  return static_cast<std::size_t>((voxel.x() & 7) * 64 + (voxel.y() & 7) * 8 + (voxel.z() & 7));
}

/// Order of ScalarGrid's leaves: x, then y, then z.
inline bool originBefore(const Index3& a, const Index3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Sorts origins and drops repeats.
inline void sortUniqueOrigins(std::vector<Index3>& origins) {
  std::sort(origins.begin(), origins.end(), originBefore);
  origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
}

}  // namespace vdbfuse
