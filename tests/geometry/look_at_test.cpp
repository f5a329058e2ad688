// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/look_at.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

TEST(LookAt, TheTargetLiesOnTheOpticAxisAndUpIsUpwardsInTheImage) {
  const Vector3d eye(1, 2, 3), target(-2, 0.5, 1);
  const RigidTransform camera_from_world = lookAt(eye, target, Vector3d::UnitZ()).inverse();
  EXPECT_LT((camera_from_world * target - Vector3d(0, 0, (target - eye).norm())).norm(), 1e-12);
  EXPECT_LT((camera_from_world * eye).norm(), 1e-12);
  const Vector3d above = camera_from_world * (target + Vector3d::UnitZ());
  EXPECT_NEAR(above.x(), 0, 1e-12);
  EXPECT_LT(above.y(), 0);
}

TEST(LookAt, IsARotationAndNoReflectionEvenStraightDown) {
  for (const Vector3d& eye : {Vector3d(0, 0, 5), Vector3d(0, 0, -5), Vector3d(3, 1, 2)}) {
    const RigidTransform pose = lookAt(eye, Vector3d::Zero(), Vector3d::UnitZ());
    EXPECT_LT(rotationError(pose.linear()), 1e-12);
    EXPECT_LT((pose.linear().col(2) + eye.normalized()).norm(), 1e-12);
  }
}

TEST(LookAt, TheFrontIsWhereDrawingsAndComputerGraphicsPutIt) {
  EXPECT_LT((frontFor(Vector3d::UnitZ()) + Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((frontFor(Vector3d::UnitY()) - Vector3d::UnitZ()).norm(), 1e-12);
  for (const Vector3d& up : {Vector3d(1, 0, 0), Vector3d(0, 0, -1), Vector3d(0, -2, 0), Vector3d(1, 2, 3)}) {
    EXPECT_NEAR(frontFor(up).dot(up), 0, 1e-12);
    EXPECT_NEAR(frontFor(up).norm(), 1, 1e-12);
  }
}

}  // namespace
}  // namespace vdbfuse
