// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/pixel_surface.h"

#include <gtest/gtest.h>

#include "fusion/packed_normal.h"
#include "fusion/scenes.h"

namespace vdbfuse {
namespace {

using test::castView;
using test::planeCaster;

TEST(PixelSurface, TheNormalsOfAPlaneAreExactFromAnySide) {
  const Pinhole camera{40, 30, 50, 45, 20, 14, {}};
  for (const double side : {1.0, -1.0}) {
    const View view = castView({0.5, 0.3, 2 * side}, {0, 0, 0}, camera, planeCaster(0));
    const PixelSurface surface = analyseSurface(view, {0, 1e-4, 0});
    for (int y = 2; y < 28; ++y)
      for (int x = 2; x < 38; ++x) {
        ASSERT_LT((surface.normal(x, y) - Eigen::Vector3f(0, 0, static_cast<float>(side))).norm(), 2e-3);
        ASSERT_EQ(surface.continuity(x, y), 1.0f) << x << " " << y;
        const Eigen::Vector3d ray =
            (worldPoint(view, x, y) - view.world_from_camera.translation()).normalized();
        ASSERT_NEAR(surface.incidence(x, y), std::abs(ray.z()), 1e-3);
      }
    EXPECT_EQ(surface.continuity(0, 0), 1.0f);  // all eight neighbours that there are
  }
}

TEST(PixelSurface, TheNormalsOfASpherePointAwayFromItsCentre) {
  const std::vector<View> views = test::sphereViews(1, 96);
  const PixelSurface surface = analyseSurface(views[0], {0, 0, 0.001});
  int count = 0;
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x) {
      if (surface.incidence(x, y) < 0.6f) continue;
      const Eigen::Vector3f expected = worldPoint(views[0], x, y).normalized().cast<float>();
      ASSERT_GT(surface.normal(x, y).dot(expected), 0.998f);
      ++count;
    }
  EXPECT_GT(count, 3000);
}

TEST(PixelSurface, OnePixelAloneHasTheSameNormal) {
  std::vector<View> views = test::sphereViews(1);
  test::addNoise(views, {0.004, 0, 0}, 2);
  const NoiseLaw noise{0.004, 0, 0};
  const PixelSurface surface = analyseSurface(views[0], noise);
  for (int i = 0; i < 64; ++i) {
    for (const int y : {0, 17, 40, 63})
      EXPECT_EQ(surfaceNormal(views[0], noise, i, y), surface.normal(i, y)) << i << " " << y;
  }
}

TEST(PackedNormal, KeepsDirectionsToATenThousandth) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    Eigen::Vector3f n(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                      static_cast<float>(random.normal()));
    if (i < 100) n[i % 3] = 0;
    n.normalize();
    const PackedNormal packed(n);
    ASSERT_FALSE(packed.isNone());
    ASSERT_LT((packed.unpack() - n).norm(), 1e-4f) << n.transpose();
  }
  for (int a = 0; a < 6; ++a) {
    const Eigen::Vector3f n = (a % 2 == 0 ? 1.0f : -1.0f) * Eigen::Vector3f::Unit(a / 2);
    EXPECT_LT((PackedNormal(n).unpack() - n).norm(), 1e-6f);
  }
  EXPECT_TRUE(PackedNormal().isNone());
  EXPECT_TRUE(PackedNormal(Eigen::Vector3f::Zero()).unpack().isZero());
}

TEST(PixelSurface, AStepEndsTheSurface) {
  View view = castView({0, 0, 2}, {0, 0, 0}, {40, 30, 50, 50, 20, 14, {}}, planeCaster(0));
  for (int y = 0; y < 30; ++y)
    for (int x = 20; x < 40; ++x) view.map.depth(x, y) += 1.0f;
  const PixelSurface surface = analyseSurface(view, {1e-3, 0, 0});
  EXPECT_EQ(surface.continuity(10, 15), 1.0f);
  EXPECT_FLOAT_EQ(surface.continuity(19, 15), 14.0f / 24);
  EXPECT_FLOAT_EQ(surface.continuity(20, 15), 14.0f / 24);
  EXPECT_GT(surface.normal(19, 15).norm(), 0.99f);
}

TEST(PixelSurface, ALonelyPixelHasNoNormalAndAnInvalidOneNothing) {
  View view = castView({0, 0, 2}, {0, 0, 0}, {40, 30, 50, 50, 20, 14, {}}, planeCaster(0));
  view.map.depth(10, 10) = 0.7f;
  view.map.depth(30, 10) = kInvalidDepth;
  const PixelSurface surface = analyseSurface(view, {1e-3, 0, 0});
  EXPECT_EQ(surface.continuity(10, 10), 0.0f);
  EXPECT_TRUE(surface.normal(10, 10).isZero());
  EXPECT_EQ(surface.incidence(10, 10), 0.0f);
  EXPECT_TRUE(surface.normal(30, 10).isZero());
  EXPECT_EQ(surface.continuity(31, 10), 1.0f);  // a hole is no evidence against its neighbours
}

}  // namespace
}  // namespace vdbfuse
