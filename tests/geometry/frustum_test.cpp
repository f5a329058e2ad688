// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "vdbfuse/base/random.h"
#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {
namespace {

Eigen::Vector3d randomPoint(Random& random, double reach) {
  return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

TEST(Frustum, ABallThatMightNotBeSeenHoldsNoPointThatIs) {
  const Pinhole camera{64, 48, 50, 60, 30, 20, {}};
  const Projector projector(camera, lookAt({0.2, -0.1, -2}, {0.3, 0.1, 0}, {0, 1, 0}));
  Random random(3);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d centre = randomPoint(random, 4);
    const double radius = random.uniform(0.01, 0.5);
    if (projector.mightSee(centre, radius)) continue;
    ++refused;
    for (int k = 0; k < 30; ++k) {
      Eigen::Vector3d offset = randomPoint(random, 1);
      if (offset.norm() > 1) offset.normalize();
      EXPECT_FALSE(projector(centre + radius * offset).has_value());
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(Frustum, ABallAroundAVisiblePointMightBeSeen) {
  const Pinhole camera{64, 48, 50, 60, 30, 20, {}};
  const Projector projector(camera, lookAt({0.2, -0.1, -2}, {0.3, 0.1, 0}, {0, 1, 0}));
  Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d point = randomPoint(random, 3);
    if (!projector(point)) continue;
    EXPECT_TRUE(projector.mightSee(point, 0.0));
    EXPECT_TRUE(projector.mightSee(point + 0.1 * randomPoint(random, 0.5), 0.1));
  }
}

TEST(Frustum, OtherProjectionsRefuseNothing) {
  Pinhole bent{64, 48, 50, 60, 30, 20, {}};
  bent.distortion[0] = -0.1;
  EXPECT_TRUE(Projector(bent, RigidTransform::Identity()).mightSee({0, 0, -5}, 0.1));
}

}  // namespace
}  // namespace vdbfuse
