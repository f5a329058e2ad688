// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/tsdf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/scenes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr double kVoxel = 0.04, kTruncation = 0.12;
const Box kDomain(Eigen::Vector3d(-0.6, -0.6, -0.6), Eigen::Vector3d(0.6, 0.6, 0.6));

TsdfVolume fuse(const std::vector<View>& views) {
  return integrateTsdf(believe(views, test::sphereSensor()), {kVoxel}, kDomain, {kTruncation});
}

TEST(Tsdf, TheZeroSetOfASphereLiesOnItWithinATenthOfTheRadius) {
  const TsdfVolume volume = fuse(test::sphereViews(30, 96));
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d direction = test::fibonacciDirection(i, 200);
    // Walk inwards: the first sign change.
    double crossing = 0;
    for (double r = 0.57; r > 0.4; r -= 0.002) {
      const float value = volume.distance.interpolate(volume.distance.frame().toIndex(r * direction));
      if (value < 0) {
        crossing = r;
        break;
      }
    }
    EXPECT_NEAR(crossing, 0.5, 0.5 * kVoxel) << direction.transpose();
  }
}

TEST(Tsdf, IsUnknownWhereNothingWasMeasured) {
  const TsdfVolume volume = fuse(test::sphereViews(30));
  EXPECT_TRUE(std::isnan(volume.distance.at({0, 0, 0})));
  EXPECT_TRUE(std::isnan(volume.distance.at({1000, 0, 0})));
  EXPECT_EQ(volume.weight.at({0, 0, 0}), 0.0f);
  for (std::size_t i = 0; i < volume.distance.leafCount(); ++i) {
    const auto distances = volume.distance.leaf(i).values, weights = volume.weight.leaf(i).values;
    for (std::size_t k = 0; k < distances.size(); ++k) {
      ASSERT_EQ(std::isnan(distances[k]), weights[k] == 0);
      if (weights[k] > 0) {
        ASSERT_LE(std::abs(distances[k]), kTruncation + 1e-6);
      }
    }
  }
}

TEST(Tsdf, OneViewLeavesTheBackOfTheSphereOpen) {
  const View front =
      test::castView({0, 0, 2}, {0, 0, 0}, test::cameraFor(64, 0.5, 2), test::sphereCaster(0.5));
  const TsdfVolume volume = fuse({front});
  EXPECT_FALSE(std::isnan(volume.distance.at({0, 0, 12})));
  EXPECT_TRUE(std::isnan(volume.distance.at({0, 0, -12})));
}

TEST(Tsdf, IsTheMeanOfTheTruncatedDistances) {
  View far = test::castView({0, 0, 2}, {0, 0, 0}, {16, 16, 20, 20, 7.5, 7.5, {}}, test::planeCaster(0));
  View near = far;
  for (float& d : near.map.depth) d -= 0.05f;
  const TsdfVolume volume = fuse({far, near});
  // At z = 0.04 the surfaces z = 0 and z = 0.05 lie 0.04 behind and 0.01 in front.
  EXPECT_NEAR(volume.distance.at({0, 0, 1}), (0.04 - 0.01) / 2, 1e-5);
  EXPECT_NEAR(volume.distance.at({0, 0, 3}), (0.12 + 0.07) / 2, 1e-5);
  EXPECT_EQ(volume.weight.at({0, 0, 3}), 2.0f);
}

}  // namespace
}  // namespace vdbfuse
