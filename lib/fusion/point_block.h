// SPDX-License-Identifier: Apache-2.0
// Points that are looked up together: their sums stay in the cache, and a view that cannot see any is skipped
// at once.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "vdbfuse/geometry/box.h"

namespace vdbfuse {

/// Up to 512 world points, relative to one of them in single precision: far from the world's origin, too,
/// they are exact to 1e-7 of the block's size.
struct PointBlock {
  static constexpr std::size_t kCapacity = 512;

  explicit PointBlock(std::span<const Eigen::Vector3d> points)
      : size(points.size()), origin(points.front()), exact(points) {
    Box box;
    for (std::size_t i = 0; i < size; ++i) {
      const Eigen::Vector3d local = points[i] - origin;
      x[i] = static_cast<float>(local.x()), y[i] = static_cast<float>(local.y());
      z[i] = static_cast<float>(local.z());
      box.extend(points[i]);
    }
    centre = box.center();
    radius = 0.5 * box.diagonal().norm() * (1 + 1e-9);
    // Loops run over whole vectors.
    for (std::size_t i = size; i < kCapacity; ++i) x[i] = y[i] = z[i] = 0.0f;
  }
  const Eigen::Vector3d& point(std::size_t i) const { return exact[i]; }

  std::size_t size;
  Eigen::Vector3d origin;
  std::span<const Eigen::Vector3d> exact;
  Eigen::Vector3d centre;  ///< of a ball that holds all points
  double radius;
  alignas(64) std::array<float, kCapacity> x, y, z;
};

/// Where one view sees the points of a block.
struct BlockLook {
  alignas(64) std::array<std::int32_t, PointBlock::kCapacity> pixel;  ///< index into its images; −1: not seen
  alignas(64) std::array<float, PointBlock::kCapacity> depth;         ///< in the sensor's own measure
};

/// What a view measured where it sees the points of a block.
enum class Measured : std::int32_t { Unseen, Nothing, Further, Nearer, Same };
struct BlockComparison {
  Measured operator[](std::size_t i) const { return static_cast<Measured>(words[i]); }
  alignas(64) std::array<std::int32_t, PointBlock::kCapacity> words;
};

/// What one view's measurements say of the points of a block.
struct BlockTestimony {
  alignas(64) std::array<float, PointBlock::kCapacity> log_ratio;  ///< log L; 0 where nothing was measured
  /// How much of a view speaks: 0 where nothing was measured, 1 in front of the measurement, e^(−(δ/τ)²) at δ
  /// behind it.
  alignas(64) std::array<float, PointBlock::kCapacity> share;
};

}  // namespace vdbfuse
