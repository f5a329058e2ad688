// SPDX-License-Identifier: Apache-2.0
// Lens distortion after Brown (1966) and Conrady (1919), on rays (x/z, y/z).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "vdbfuse/geometry/projection.h"

namespace vdbfuse {

bool isDistorted(const Pinhole& camera);

/// The distorted ray; nothing beyond the radius where the model folds back (it stops being monotone there,
/// and points far outside the image would land inside it).
std::optional<Eigen::Vector2d> distort(const Pinhole& camera, const Eigen::Vector2d& ray);

/// Inverse of distort(), by Newton's method to 1e-12.
Eigen::Vector2d undistort(const Pinhole& camera, const Eigen::Vector2d& distorted);

}  // namespace vdbfuse
