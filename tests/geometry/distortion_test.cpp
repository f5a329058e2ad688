// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/distortion.h"

#include <gtest/gtest.h>

#include "geometry/projections.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

TEST(Distortion, IsTheFormulaOfBrownAndConrady) {
  const Pinhole camera = test::distortedPinhole();
  const auto [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = 0.3, y = -0.2, r2 = x * x + y * y;
  const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
  const auto distorted = distort(camera, {x, y});
  ASSERT_TRUE(distorted);
  EXPECT_NEAR(distorted->x(), x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), 1e-15);
  EXPECT_NEAR(distorted->y(), y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y, 1e-15);
}

TEST(Distortion, UndistortIsItsInverse) {
  const Pinhole camera = test::distortedPinhole();
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d ray(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7));
    EXPECT_LT((undistort(camera, *distort(camera, ray)) - ray).norm(), 1e-11);
  }
}

TEST(Distortion, RaysBeyondTheFoldAreNotSeen) {
  // r (1 − 0.3 r²) grows up to r = 1.054 and comes back to 0 at 1.83.
  Pinhole camera{640, 480, 500, 500, 320, 240, {-0.3, 0, 0, 0, 0}};
  EXPECT_TRUE(distort(camera, {1.05, 0}));
  EXPECT_FALSE(distort(camera, {1.06, 0}));
  EXPECT_FALSE(distort(camera, {1.8, 0}));
  EXPECT_FALSE(distort(camera, {100, 0}));
  EXPECT_FALSE(project(camera, Eigen::Vector3d(1.8, 0, 1)));
  EXPECT_FALSE(isDistorted(Pinhole{640, 480, 500, 500, 320, 240, {}}));
}

}  // namespace
}  // namespace vdbfuse
