// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

namespace vdbfuse {

/// Axis-aligned box in world coordinates.
using Box = Eigen::AlignedBox3d;

}  // namespace vdbfuse
