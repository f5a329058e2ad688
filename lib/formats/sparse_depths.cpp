// SPDX-License-Identifier: Apache-2.0
#include "formats/sparse_depths.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdbfuse {
namespace {

// The value that `share` of the others lie below. REQUIRES: sorted, not empty.
double quantile(const std::vector<float>& sorted, double share) {
  const auto last = static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::lround(share * last))];
}

}  // namespace

SparseDepths::SparseDepths(std::vector<RigidTransform> camera_from_world)
    : camera_from_world_(std::move(camera_from_world)), depths_(camera_from_world_.size()) {}

void SparseDepths::add(std::size_t index, const Eigen::Vector3d& point_in_world) {
  const auto depth = static_cast<float>((camera_from_world_[index] * point_in_world).z());
  if (depth > 0 && std::isfinite(depth)) depths_[index].push_back(depth);
}

std::optional<DepthInterval> SparseDepths::interval(std::size_t index) const {
  constexpr std::size_t kFewest = 8;
  constexpr double kMargin = 0.1;
  std::vector<float> depths = depths_[index];
  if (depths.size() < kFewest) return std::nullopt;
  std::sort(depths.begin(), depths.end());
  const double low = quantile(depths, 0.01), high = quantile(depths, 0.99);
  if (!(high > low)) return std::nullopt;
  const double margin = kMargin * (high - low);
  return DepthInterval{std::max(low - margin, 0.5 * low), high + margin};
}

}  // namespace vdbfuse
