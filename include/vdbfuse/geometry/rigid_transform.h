// SPDX-License-Identifier: Apache-2.0
// Rigid transforms. A transform named b_from_a takes points given in frame a to frame b: x_in_b = b_from_a *
// x_in_a. Camera frames: x right, y down, z forward. Lengths in metres, or in the unit of the input's poses.
#pragma once

#include <Eigen/Geometry>

namespace vdbfuse {

using RigidTransform = Eigen::Isometry3d;

/// Rotation nearest to `matrix` in the sense of Frobenius.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix);

/// Largest entry of |RᵀR − 1|; above 2 when R mirrors or holds a non-finite number.
double rotationError(const Eigen::Matrix3d& matrix);

/// Poses on disk are orthonormal to about 1e-3 only; anything further off is not a rotation.
inline constexpr double kRotationTolerance = 0.02;

/// The rigid transform of the upper 3×4 part of `matrix`, its rotation made exact.
/// Throws InvalidArgument when the rotation part is off by more than kRotationTolerance or mirrors.
RigidTransform rigidFromMatrix(const Eigen::Matrix4d& matrix);

}  // namespace vdbfuse
