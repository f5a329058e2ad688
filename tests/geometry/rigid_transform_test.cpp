// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/rigid_transform.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

Eigen::Matrix4d somePose() {
  RigidTransform pose = RigidTransform::Identity();
  pose.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(1, 2, 3);
  return pose.matrix();
}

std::string complaint(const Eigen::Matrix4d& matrix) {
  try {
    rigidFromMatrix(matrix);
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "";
}

TEST(RigidTransform, AnExactPoseComesBackAsItIs) {
  EXPECT_LT((rigidFromMatrix(somePose()).matrix() - somePose()).norm(), 1e-12);
}

TEST(RigidTransform, ARotationThatIsNearlyOneIsMadeExactAndStaysNear) {
  Eigen::Matrix4d pose = somePose();
  pose(0, 1) += 1e-3, pose(2, 2) -= 2e-3;
  const RigidTransform rigid = rigidFromMatrix(pose);
  EXPECT_LT(rotationError(rigid.linear()), 1e-12);
  EXPECT_LT((rigid.matrix() - somePose()).norm(), 4e-3);
  EXPECT_EQ(rigid.translation(), Eigen::Vector3d(1, 2, 3));
}

TEST(RigidTransform, WhatIsNoRotationIsRefusedWithTheReason) {
  Eigen::Matrix4d scaled = somePose();
  scaled.topLeftCorner<3, 3>() *= 1.1;
  EXPECT_EQ(complaint(scaled).find("pose: expected a rotation, found a matrix with |RᵀR - 1| = 0.21"), 0u)
      << complaint(scaled);
  Eigen::Matrix4d mirrored = somePose();
  mirrored.col(0) *= -1;
  EXPECT_EQ(complaint(mirrored), "pose: expected a rotation, found a matrix that mirrors");
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Eigen::Matrix4d broken = somePose();
    broken(1, 3) = bad;
    EXPECT_EQ(complaint(broken), "pose: expected finite numbers");
  }
}

TEST(RigidTransform, TheRotationErrorIsTheLargestEntry) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  EXPECT_EQ(rotationError(matrix), 0);
  matrix(1, 1) = 1.1;
  EXPECT_NEAR(rotationError(matrix), 0.21, 1e-12);
  EXPECT_GT(rotationError(-Eigen::Matrix3d::Identity()), 2);
  matrix(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_GT(rotationError(matrix), 2);
}

TEST(RigidTransform, TheNearestRotationNeverMirrors) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1, 1, -0.5).asDiagonal();
  EXPECT_LT((nearestRotation(mirror) - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

}  // namespace
}  // namespace vdbfuse
