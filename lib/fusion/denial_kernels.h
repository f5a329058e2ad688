// SPDX-License-Identifier: Apache-2.0
// The smallest evidence along many rays, for the best instruction set of the machine.
#pragma once

#include <array>
#include <cstddef>

namespace vdbfuse {

/// Evidence at the points of a regular grid, in bricks of 8³: x fastest, in bricks as well as of them. Point
/// (i, j, k) speaks for [i, i+1) × [j, j+1) × [k, k+1).
struct BrickedEvidence {
  static constexpr int kBrick = 8, kHalf = kBrick / 2;
  static constexpr std::size_t kOctants = 8, kOctant = kHalf * kHalf * kHalf;

  const float* values;
  const float* smallest;             ///< of each octant of each brick
  std::array<int, 3> points_a_side;  ///< whole bricks
};

/// Rays in grid steps.
struct RayBatch {
  static constexpr std::size_t kCapacity = 64;
  std::size_t size = 0;
  alignas(64) std::array<std::array<float, kCapacity>, 3> start{}, way{};
  alignas(64) std::array<float, kCapacity> safe{};  ///< share of the way that need not be looked at
  /// Found: the smallest of the points that are met going a step at a time, or `most` when all are larger.
  alignas(64) std::array<float, kCapacity> smallest{};
};

void findSmallest(const BrickedEvidence& evidence, float most, RayBatch& rays);

}  // namespace vdbfuse
