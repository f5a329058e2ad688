// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/pixel_surface.h"

#include <gtest/gtest.h>

#include "fusion/packed_normal.h"
#include "fusion/scenes.h"
#include "fusion/surface_kernels.h"

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

// A sphere with noise, holes and a background that begins anywhere.
View brokenSphere(int width, int height) {
  Pinhole camera = test::cameraFor(64, 0.5, 2.0);
  camera.width = width, camera.height = height, camera.fy *= 1.1;
  std::vector<View> views{castView({0.9, -1.2, 1.3}, {0, 0, 0}, camera, test::sphereCaster(0.5))};
  test::addNoise(views, {0.004, 0, 0}, 2);
  Random random(7);
  for (float& d : views[0].map.depth) {
    if (random.uniform() < 0.1) d = kInvalidDepth;
    if (random.uniform() < 0.1) d = static_cast<float>(random.uniform(1.0, 3.0));
  }
  return views[0];
}

const NoiseLaw kFallingNoise{0.012, -0.008, 0.002};  // the least at 2

TEST(PixelSurface, OnePixelAloneHasTheSameNormal) {
  const View view = brokenSphere(61, 59);
  const PixelSurface surface = analyseSurface(view, kFallingNoise);
  int known = 0;
  for (int x = 0; x < 61; ++x) {
    for (const int y : {0, 17, 30, 40, 58}) {
      const Eigen::Vector3f alone = surfaceNormal(view, kFallingNoise, x, y);
      EXPECT_LT((alone - surface.normal(x, y)).norm(), 1e-4f) << x << " " << y;
      known += !alone.isZero();
    }
  }
  EXPECT_GT(known, 80);
}

// A distortion of nothing goes the way of all projections, pixel by pixel.
TEST(PixelSurface, ManyPixelsOfAPinholeAtATimeAreWhatTheyAreOneByOne) {
  for (const int width : {61, 16, 5}) {
    View view = brokenSphere(width, 59);
    const PixelSurface together = analyseSurface(view, kFallingNoise);
    std::get<Pinhole>(view.projection).distortion[0] = 1e-13;
    const PixelSurface alone = analyseSurface(view, kFallingNoise);
    EXPECT_EQ(together.continuity, alone.continuity);
    for (std::size_t p = 0; p < alone.normal.size(); ++p) {
      ASSERT_LT((together.normal.data()[p] - alone.normal.data()[p]).norm(), 1e-4f) << p;
      ASSERT_NEAR(together.incidence.data()[p], alone.incidence.data()[p], 1e-4f) << p;
    }
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

TEST(PackedNormal, ARowOfThemIsPackedAsEachIs) {
  SurfaceRow row(37);
  Random random(4);
  std::vector<Eigen::Vector3f> normals;
  for (std::size_t i = 0; i < 37; ++i) {
    Eigen::Vector3f n(static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                      static_cast<float>(random.normal()));
    if (i < 6) n = (i % 2 == 0 ? 1.0f : -1.0f) * Eigen::Vector3f::Unit(static_cast<Eigen::Index>(i / 2));
    n = i % 7 == 6 ? Eigen::Vector3f::Zero() : Eigen::Vector3f(n.normalized());
    row.x[i] = n.x(), row.y[i] = n.y(), row.z[i] = n.z();
    normals.push_back(n);
  }
  std::vector<PackedNormal> packed(37);
  packNormals(row, packed.data());
  for (std::size_t i = 0; i < 37; ++i) {
    EXPECT_EQ(packed[i].isNone(), normals[i].isZero()) << i;
    EXPECT_LT((packed[i].unpack() - normals[i]).norm(), 1e-4f) << i;
  }
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
