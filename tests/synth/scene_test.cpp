// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/synth/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

constexpr double kCoarse = 1.0 / 120;

class EveryScene : public testing::TestWithParam<std::string> {
 protected:
  Scene scene = makeScene(GetParam(), {kCoarse});
};

TEST_P(EveryScene, HasAClosedManifoldForItsTruth) {
  const TopologyReport report = topology(scene.truth);
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.euler_number, GetParam() == "torus" ? 0 : 2);
  EXPECT_GT(signedVolume(scene.truth), 0);
}

TEST_P(EveryScene, HasADiagonalOfOneOrADiameterAndItsCentreAtTheOrigin) {
  const Box bounds = boundingBox(scene.truth);
  EXPECT_NEAR(bounds.diagonal().norm(), GetParam() == "ball" ? std::sqrt(3.0) : 1.0, 2e-3);
  EXPECT_LT(bounds.center().norm(), 1e-3);
}

TEST_P(EveryScene, HasTheVerticesOfItsTruthOnTheSurface) {
  double worst = 0, sum = 0;
  for (const Eigen::Vector3f& v : scene.truth.vertices) {
    const double off = std::abs(scene.distance(v.cast<double>()));
    worst = std::max(worst, off), sum += off;
  }
  EXPECT_LT(worst, 0.15 * kCoarse);  // in creases of the figure
  EXPECT_LT(sum, 1e-3 * kCoarse * static_cast<double>(scene.truth.vertices.size()));
}

TEST_P(EveryScene, AgreesWithItsRegions) {
  Random random(3);
  for (const SceneRegion& region : scene.regions) {
    int tried = 0;
    for (int i = 0; i < 2000000; ++i) {
      const Vector3d p(random.uniform(-.5, .5), random.uniform(-.5, .5), random.uniform(-.5, .5));
      if (!contains(region.shape, p)) continue;
      ++tried;
      EXPECT_EQ(scene.distance(p) > 0, region.expect == RegionSide::Outside) << region.name;
    }
    EXPECT_GT(tried, 10) << region.name;
  }
}

TEST_P(EveryScene, NeverOverstatesADistance) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const Vector3d p(random.uniform(-.6, .6), random.uniform(-.6, .6), random.uniform(-.6, .6));
    double nearest = 1e9;
    for (const Eigen::Vector3f& v : scene.truth.vertices)
      nearest = std::min(nearest, (v.cast<double>() - p).norm());
    EXPECT_LE(std::abs(scene.distance(p)), nearest + 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Synth, EveryScene, testing::ValuesIn(sceneNames()),
                         [](const auto& scene) { return scene.param; });

TEST(Scene, TheSphereHasTheVolumeOfASphere) {
  const double radius = 0.5 / std::sqrt(3.0);
  EXPECT_NEAR(signedVolume(makeScene("sphere", {1.0 / 160}).truth),
              4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3), 1e-4);
}

TEST(Scene, TheBoxKeepsItsSharpEdges) {
  const Scene scene = makeScene("box", {kCoarse});
  const Box bounds = boundingBox(scene.truth);
  EXPECT_NEAR(bounds.volume(), signedVolume(scene.truth), 1e-5);
}

TEST(Scene, TheLegsOfTheFigureAreFourPercentOfItsHeightThick) {
  const Scene scene = makeScene("figure", {kCoarse});
  const double height = boundingBox(scene.truth).sizes().z();
  const auto leg = std::find_if(scene.regions.begin(), scene.regions.end(),
                                [](const SceneRegion& r) { return r.name == "left leg"; });
  ASSERT_NE(leg, scene.regions.end());
  const auto& core = std::get<CylinderShape>(leg->shape);
  EXPECT_NEAR(-scene.distance(0.5 * (core.from + core.to)), 0.02 * height, 1e-3);
}

TEST(Scene, TheCavityOfTheFigureIsTwiceAsDeepAsWideAndOpensToTheFront) {
  const Scene scene = makeScene("figure", {kCoarse});
  const double height = boundingBox(scene.truth).sizes().z();
  const Vector3d opening = std::get<Box>(scene.regions.front().shape).center();
  ASSERT_EQ(scene.regions.front().name, "cavity");
  const auto freeUntil = [&](const Vector3d& from, const Vector3d& direction) {
    double t = 0;
    while (t < 1 && scene.distance(from + t * direction) > 0) t += 1e-4;
    return t;
  };
  const double width = freeUntil(opening, Vector3d::UnitX()) + freeUntil(opening, -Vector3d::UnitX());
  EXPECT_NEAR(width, 0.1 * height, 1e-3);
  const double front = boundingBox(scene.truth).min().y();
  EXPECT_NEAR(opening.y() + freeUntil(opening, Vector3d::UnitY()) - front, 0.2 * height, 1e-3);
  EXPECT_GE(freeUntil(opening, scene.front), 1);
}

TEST(Scene, AMeshIsMovedAndScaledToTheUnitDiagonal) {
  const Scene scene = sceneFromMesh("ball", test::sphere(7.0, 3, {1, 2, 3}));
  const Box bounds = boundingBox(scene.truth);
  EXPECT_NEAR(bounds.diagonal().norm(), 1, 1e-6);
  EXPECT_LT(bounds.center().norm(), 1e-6);
}

TEST(Scene, ARoomIsAClosedShellAroundTheObject) {
  const Scene scene = inRoom(makeScene("sphere", {kCoarse}));
  const TopologyReport report = topology(scene.truth);
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.components, 3u);
  EXPECT_GT(scene.distance({1, 0, 0}), 0);
  EXPECT_LT(scene.distance({kRoomHalfSize.x() + 0.5 * kRoomWall, 0, 0}), 0);
  EXPECT_NEAR(scene.distance({kRoomHalfSize.x() - 0.1, 0, 0}), 0.1, 1e-12);
  const double shell = 8 * ((kRoomHalfSize.array() + kRoomWall).prod() - kRoomHalfSize.prod());
  const double ball = 4.0 / 3.0 * std::numbers::pi * std::pow(0.5 / std::sqrt(3.0), 3);
  EXPECT_NEAR(signedVolume(scene.truth), shell + ball, 1e-3);
}

TEST(Scene, AnUnknownNameIsRefused) {
  EXPECT_THROW(
      {
        try {
          makeScene("teapot");
        } catch (const InvalidArgument& error) {
          EXPECT_STREQ(error.what(), "scene: unknown name 'teapot'");
          throw;
        }
      },
      InvalidArgument);
}

TEST(Scene, AMeshWithoutTrianglesIsRefused) { EXPECT_THROW(sceneFromMesh("nothing", {}), InvalidArgument); }

}  // namespace
}  // namespace vdbfuse
