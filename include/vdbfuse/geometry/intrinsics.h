// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "vdbfuse/geometry/projection.h"

namespace vdbfuse {

/// K: fx 0 cx, 0 fy cy, 0 0 1. Distortion is not in it.
inline Eigen::Matrix3d intrinsicMatrix(const Pinhole& camera) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  matrix(0, 0) = camera.fx, matrix(1, 1) = camera.fy;
  matrix(0, 2) = camera.cx, matrix(1, 2) = camera.cy;
  return matrix;
}

}  // namespace vdbfuse
