// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/calibrate.h"

#include <gtest/gtest.h>

#include "fusion/scenes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

// Views of the inside of a sphere of radius 2 from places away from its centre: depths from 0.6 to 3.4.
std::vector<View> hollowViews(const NoiseLaw& law) {
  std::vector<View> views;
  for (int i = 0; i < 16; ++i) {
    const Eigen::Vector3d eye = 1.3 * test::fibonacciDirection(i, 16);
    views.push_back(test::castView(eye, -eye + Eigen::Vector3d(0.2, 0.1, 0.3),
                                   {64, 64, 32, 32, 31.5, 31.5, {}},
                                   [](const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
                                     const double b = o.dot(d);
                                     return -b + std::sqrt(b * b - o.squaredNorm() + 4);
                                   }));
  }
  test::addNoise(views, law, 3);
  return views;
}

NoiseCalibration calibrate(const std::vector<View>& views) {
  const double typical = depthStatistics(views).median;
  const ViewGraph graph(test::headersOf(views), typical);
  return calibrateNoise(views, graph, guessNoise(views, typical), typical);
}

// Pixels of 2° and depths that differ fivefold between the two views of a pair: the scale comes out up to 25
// % too large.
TEST(CalibrateNoise, RecoversThePlantedScaleWithinAThirdInAHardPlace) {
  for (const NoiseLaw& law : {NoiseLaw{0.02, 0, 0}, NoiseLaw{0, 0.008, 0}, NoiseLaw{0, 0, 0.004}}) {
    const std::vector<View> views = hollowViews(law);
    const NoiseCalibration found = calibrate(views);
    const double truth = law.at(depthStatistics(views).median);
    EXPECT_NEAR(found.scale_at_median, truth, 0.33 * truth);
    EXPECT_NEAR(found.noise.at(depthStatistics(views).median), found.scale_at_median, 1e-12);
    EXPECT_GT(found.pairs, 400u);
  }
}

TEST(CalibrateNoise, RecoversTheScaleOnASphereSeenFromOutside) {
  for (const double noise : {0.002, 0.006}) {
    std::vector<View> views = test::sphereViews(24, 64);
    test::addNoise(views, {noise, 0, 0}, 4);
    EXPECT_NEAR(calibrate(views).scale_at_median, noise, 0.1 * noise + 0.0003);
  }
}

TEST(CalibrateNoise, ATenthOfWildDepthsMovesItLittle) {
  std::vector<View> views = hollowViews({0.01, 0, 0});
  Random random(1);
  for (View& view : views)
    for (float& d : view.map.depth)
      if (random.uniform() < 0.1) d = static_cast<float>(random.uniform(0.5, 3.5));
  const double clean = calibrate(hollowViews({0.01, 0, 0})).scale_at_median;
  EXPECT_NEAR(calibrate(views).scale_at_median, clean, 0.1 * clean);
}

TEST(CalibrateNoise, WithoutOverlapTheGuessIsKept) {
  const std::vector<View> views = {test::sphereViews(1).front()};
  const NoiseLaw guess{0, 0.003, 0};
  const ViewGraph graph(test::headersOf(views), 1.5);
  const NoiseCalibration found = calibrateNoise(views, graph, guess, 1.5);
  EXPECT_EQ(found.noise, guess);
  EXPECT_EQ(found.pairs, 0u);
}

TEST(CalibrateNoise, IsTheSameForOneAndTwoThreads) {
  const std::vector<View> views = hollowViews({0.01, 0, 0});
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return calibrate(views).scale_at_median;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(GuessNoise, IsTheNoiseOfNeighbouringPixels) {
  std::vector<View> views = {
      test::castView({0, 0, 2}, {0, 0, 0}, {96, 96, 80, 80, 47.5, 47.5, {}}, test::planeCaster(0))};
  test::addNoise(views, {0.01, 0, 0}, 3);
  EXPECT_NEAR(guessNoise(views, 2.0).at(2.0), 0.01, 0.001);
}

TEST(DepthStatistics, TheMedianIsThatOfTheDomain) {
  std::vector<View> views = test::sphereViews(4);
  for (View& view : views)
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        if (std::max(std::abs(x - 32), std::abs(y - 32)) > 10) view.map.depth(x, y) = 9.0f;
  const Box around(Eigen::Vector3d::Constant(-0.6), Eigen::Vector3d::Constant(0.6));
  EXPECT_NEAR(depthStatistics(views).median, 9, 1e-6);
  EXPECT_LT(depthStatistics(views, around).median, 2.1);
  EXPECT_EQ(depthStatistics(views, around).far, depthStatistics(views).far);
  const Box nowhere(Eigen::Vector3d::Constant(20), Eigen::Vector3d::Constant(21));
  EXPECT_NEAR(depthStatistics(views, nowhere).median, 9, 1e-6);
}

TEST(DepthStatistics, AreQuantilesThatOneWildDepthDoesNotMove) {
  std::vector<View> views = test::sphereViews(4);
  const DepthStatistics clean = depthStatistics(views);
  EXPECT_NEAR(clean.near, 0.97 * 1.5, 0.01);
  EXPECT_GT(clean.far, 1.8);
  EXPECT_LT(clean.far, 1.03 * 2.0);
  views[0].map.depth(32, 32) = 1e6f;
  EXPECT_NEAR(depthStatistics(views).far, clean.far, 0.01);
  for (View& view : views) view.map.depth = Image<float>(64, 64);
  EXPECT_THROW(depthStatistics(views), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
