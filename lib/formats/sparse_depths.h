// SPDX-License-Identifier: Apache-2.0
// Depths of what photographs see, from the sparse points of a reconstruction.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse {

class SparseDepths {
 public:
  explicit SparseDepths(std::vector<RigidTransform> camera_from_world);

  /// Photograph `index` sees the point. Behind it: ignored. REQUIRES: index is one of the photographs.
  void add(std::size_t index, const Eigen::Vector3d& point_in_world);

  /// From the 1 % to the 99 % quantile of the depths, widened by a tenth at either end, never below half the
  /// nearest; nothing when fewer than eight points were seen, or all at one depth.
  std::optional<DepthInterval> interval(std::size_t index) const;

 private:
  std::vector<RigidTransform> camera_from_world_;
  std::vector<std::vector<float>> depths_;
};

}  // namespace vdbfuse
