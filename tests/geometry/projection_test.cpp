// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/projection.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "geometry/projections.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class EveryProjection : public testing::TestWithParam<std::size_t> {
 protected:
  Projection sensor = test::oneOfEach()[GetParam()];
  Random random{GetParam() + 1};
  PixelDepth randomPixel() {
    return {random.uniform(-0.5, imageWidth(sensor) - 0.5), random.uniform(-0.5, imageHeight(sensor) - 0.5),
            random.uniform(0.2, 5)};
  }
};
INSTANTIATE_TEST_SUITE_P(Projections, EveryProjection, testing::Range<std::size_t>(0, 6));

TEST_P(EveryProjection, ProjectUndoesUnproject) {
  for (int i = 0; i < 500; ++i) {
    const PixelDepth p = randomPixel();
    const auto back = project(sensor, unproject(sensor, p.x, p.y, p.depth));
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->x, p.x, 1e-8);
    EXPECT_NEAR(back->y, p.y, 1e-8);
    EXPECT_NEAR(back->depth, p.depth, 1e-9);
  }
}

TEST_P(EveryProjection, AScaledSensorSeesTheSameRays) {
  for (const double factor : {0.5, 2.0, 3.0}) {
    const Projection other = scaled(sensor, factor);
    EXPECT_EQ(imageWidth(other), std::lround(imageWidth(sensor) * factor));
    for (int i = 0; i < 100; ++i) {
      const PixelDepth p = randomPixel();
      const Eigen::Vector3d a = unproject(sensor, p.x, p.y, p.depth);
      const Eigen::Vector3d b =
          unproject(other, (p.x + 0.5) * factor - 0.5, (p.y + 0.5) * factor - 0.5, p.depth);
      EXPECT_LT((a - b).norm(), 1e-9);
    }
  }
}

TEST_P(EveryProjection, RaysAreUnitVectorsAlongWhichTheDepthGrowsAndThePixelStays) {
  for (int i = 0; i < 100; ++i) {
    const PixelDepth p = randomPixel();
    const Eigen::Vector3d ray = rayDirection(sensor, p.x, p.y, p.depth);
    EXPECT_NEAR(ray.norm(), 1, 1e-12);
    const auto further = project(sensor, unproject(sensor, p.x, p.y, p.depth) + 0.1 * ray);
    ASSERT_TRUE(further);
    EXPECT_GT(further->depth, p.depth);
    EXPECT_NEAR(further->x, p.x, 1e-6);
    EXPECT_NEAR(further->y, p.y, 1e-6);
  }
}

TEST_P(EveryProjection, TheFootprintIsTheSpacingOfThePixelsInTheMiddle) {
  const double x = imageWidth(sensor) / 2, y = imageHeight(sensor) / 2, depth = 2;
  const auto at = [&](double dx, double dy) { return unproject(sensor, x + dx, y + dy, depth); };
  const double area = (at(1, 0) - at(0, 0)).cross(at(0, 1) - at(0, 0)).norm();
  EXPECT_NEAR(footprint(sensor, depth), std::sqrt(area), 0.05 * std::sqrt(area));
}

TEST_P(EveryProjection, TheProjectorAgreesWithProject) {
  RigidTransform world_from_camera = RigidTransform::Identity();
  world_from_camera.linear() =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  world_from_camera.translation() = Eigen::Vector3d(3, -2, 1);
  const Projector projector(sensor, world_from_camera);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d camera(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-1, 5));
    const auto expected = project(sensor, camera);
    const auto seen = projector(world_from_camera * camera);
    const bool in_image = expected && expected->x >= -0.5 && expected->x < imageWidth(sensor) - 0.5 &&
                          expected->y >= -0.5 && expected->y < imageHeight(sensor) - 0.5;
    ASSERT_EQ(seen.has_value(), in_image);
    if (!seen) continue;
    ++inside;
    EXPECT_EQ(seen->x, nearestPixel(expected->x));
    EXPECT_EQ(seen->y, nearestPixel(expected->y));
    EXPECT_NEAR(seen->depth, expected->depth, 1e-9);
  }
  EXPECT_GT(inside, 50);
}

TEST_P(EveryProjection, TheUnprojectorAgreesWithUnproject) {
  RigidTransform world_from_camera(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()));
  world_from_camera.translation() = Eigen::Vector3d(3, -2, 1);
  const Unprojector unprojector(sensor, world_from_camera);
  for (int i = 0; i < 100; ++i) {
    const double x = random.uniform(0, imageWidth(sensor)), y = random.uniform(0, imageHeight(sensor)),
                 depth = random.uniform(0.5, 5);
    const Eigen::Vector3d expected = world_from_camera * unproject(sensor, x, y, depth);
    EXPECT_LT((unprojector(x, y, depth) - expected).norm(), 1e-12);
  }
}

TEST_P(EveryProjection, NumbersThatCannotBeAreReported) {
  EXPECT_TRUE(validate(sensor).empty());
  std::visit([](auto& p) { p.width = 0; }, sensor);
  EXPECT_EQ(validate(sensor).size(), 1u);
}

TEST(Projection, WhatLiesBehindIsNotSeen) {
  for (const Projection& sensor : test::oneOfEach()) {
    EXPECT_FALSE(project(sensor, Eigen::Vector3d(0, 0, 0)));
    if (std::holds_alternative<Spherical>(sensor)) continue;
    EXPECT_FALSE(project(sensor, Eigen::Vector3d(0.1, 0.1, -1)));
    EXPECT_FALSE(project(sensor, Eigen::Vector3d(0, 0, kNan)));
  }
}

TEST(Projection, AFullTurnHasNoGapAtItsSeam) {
  const double step = 2 * std::numbers::pi / 100;
  const Projector scanner(Spherical{100, 10, 0.4, step, -0.5, 0.1}, RigidTransform::Identity());
  for (int i = 0; i < 1000; ++i) {
    const double azimuth = 0.001 + 2 * std::numbers::pi * i / 1000;
    const auto seen = scanner({std::sin(azimuth), 0, std::cos(azimuth)});
    ASSERT_TRUE(seen) << azimuth;
    const double off = std::remainder(0.4 + seen->x * step - azimuth, 2 * std::numbers::pi);
    EXPECT_LE(std::abs(off), step / 2 + 1e-9);
  }
}

TEST(Projection, HalfWayCasesGoUp) {
  EXPECT_EQ(nearestPixel(0.49), 0);
  EXPECT_EQ(nearestPixel(0.5), 1);
  EXPECT_EQ(nearestPixel(-0.5), 0);
  EXPECT_EQ(nearestPixel(-0.51), -1);
  EXPECT_EQ(nearestPixel(1.5), 2);
}

TEST(Projection, EachKindNamesWhatIsWrong) {
  EXPECT_EQ(validate(Pinhole{4, 3, 0, 1, kNan, 0, {kNan}}).size(), 3u);
  EXPECT_EQ(validate(Spherical{4, 3, kNan, 0, 0, 1}).size(), 2u);
  EXPECT_EQ(validate(Orthographic{4, 3, 0, 0, kNan, 1}).size(), 2u);
  EXPECT_EQ(validate(PushBroom{4, 0, 0, 0, kNan, 1, 0}).size(), 3u);
}

}  // namespace
}  // namespace vdbfuse
