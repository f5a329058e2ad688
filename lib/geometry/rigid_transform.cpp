// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/rigid_transform.h"

#include <Eigen/SVD>
#include <string>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  return u * svd.matrixV().transpose();
}

double rotationError(const Eigen::Matrix3d& matrix) {
  constexpr double kNotARotation = 3.0;
  if (!matrix.allFinite() || matrix.determinant() <= 0) return kNotARotation;
  return (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

RigidTransform rigidFromMatrix(const Eigen::Matrix4d& matrix) {
  if (!matrix.topRows<3>().allFinite()) throw InvalidArgument("pose", "expected finite numbers");
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  if (rotation.determinant() <= 0)
    throw InvalidArgument("pose", "expected a rotation, found a matrix that mirrors");
  const double error = rotationError(rotation);
  if (error > kRotationTolerance) {
    throw InvalidArgument("pose",
                          "expected a rotation, found a matrix with |RᵀR - 1| = " + std::to_string(error));
  }
  RigidTransform result = RigidTransform::Identity();
  result.linear() = nearestRotation(rotation);
  result.translation() = matrix.topRightCorner<3, 1>();
  return result;
}

}  // namespace vdbfuse
