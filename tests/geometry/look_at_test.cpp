// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/look_at.h"

#include <gtest/gtest.h>

#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

TEST(LookAt, TheTargetLiesOnTheAxisAndUpIsUpwards) {
  Random random(4);
  const auto vector = [&] { return Eigen::Vector3d(random.normal(), random.normal(), random.normal()); };
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d eye = vector(), target = vector(), up = vector();
    const RigidTransform world_from_camera = lookAt(eye, target, up);
    EXPECT_LT(rotationError(world_from_camera.linear()), 1e-12);
    const RigidTransform camera_from_world = world_from_camera.inverse();
    EXPECT_LT((camera_from_world * target - Eigen::Vector3d(0, 0, (target - eye).norm())).norm(), 1e-9);
    const Eigen::Vector3d up_in_camera = camera_from_world.linear() * up;
    EXPECT_NEAR(up_in_camera.x(), 0, 1e-9);
    EXPECT_LT(up_in_camera.y(), 0);
  }
}

TEST(LookAt, LookingAlongUpIsStillARotation) {
  const RigidTransform pose = lookAt({0, 0, 5}, {0, 0, 0}, Eigen::Vector3d::UnitZ());
  EXPECT_LT(rotationError(pose.linear()), 1e-12);
  EXPECT_LT((pose.linear().col(2) + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(LookAt, TheFrontIsAtRightAnglesToUp) {
  EXPECT_LT((frontFor(Eigen::Vector3d::UnitZ()) + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((frontFor(Eigen::Vector3d::UnitY()) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  for (const Eigen::Vector3d& up : {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(1, 2, 3)}) {
    EXPECT_NEAR(frontFor(up).dot(up), 0, 1e-9);
    EXPECT_NEAR(frontFor(up).norm(), 1, 1e-9);
  }
}

}  // namespace
}  // namespace vdbfuse
