// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/noise_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {
namespace {

constexpr NoiseShape kShapes[] = {NoiseShape::Gaussian, NoiseShape::Logistic, NoiseShape::Laplace};

TEST(NoiseModel, TheCdfIsTheIntegralOfItsDensity) {
  const auto density = [](NoiseShape shape, double u) {
    if (shape == NoiseShape::Gaussian) return std::exp(-u * u / 2) / std::sqrt(2 * std::numbers::pi);
    if (shape == NoiseShape::Laplace) return 0.5 * std::exp(-std::abs(u));
    return 0.25 / std::pow(std::cosh(u / 2), 2);
  };
  for (const NoiseShape shape : kShapes) {
    for (double u = -4; u < 4; u += 0.5) {
      constexpr int kSteps = 100;
      double integral = 0;  // by Simpson's rule
      for (int i = 0; i <= kSteps; ++i)
        integral += (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * density(shape, u + 0.5 * i / kSteps);
      integral *= 0.5 / kSteps / 3;
      EXPECT_NEAR(noiseCdf(shape, u + 0.5) - noiseCdf(shape, u), integral, 1e-9);
    }
  }
}

TEST(NoiseModel, TheCdfIsSymmetricAndAccurateInItsTails) {
  for (const NoiseShape shape : kShapes) {
    EXPECT_DOUBLE_EQ(noiseCdf(shape, 0), 0.5);
    EXPECT_EQ(noiseCdf(shape, -std::numeric_limits<double>::infinity()), 0);
    EXPECT_EQ(noiseCdf(shape, std::numeric_limits<double>::infinity()), 1);
    for (const double u : {0.3, 2.0, 8.0}) EXPECT_NEAR(noiseCdf(shape, u) + noiseCdf(shape, -u), 1, 1e-15);
  }
  EXPECT_NEAR(noiseCdf(NoiseShape::Gaussian, -10) / 7.619853024160527e-24, 1, 1e-12);
  EXPECT_NEAR(noiseCdf(NoiseShape::Logistic, -100) / std::exp(-100.0), 1, 1e-12);
  EXPECT_NEAR(noiseCdf(NoiseShape::Laplace, -100) / (0.5 * std::exp(-100.0)), 1, 1e-12);
}

TEST(NoiseModel, TheLawIsAPolynomialOfTheDepth) {
  const NoiseLaw law{1, 2, 3};
  EXPECT_DOUBLE_EQ(law.at(2), 17);
  EXPECT_DOUBLE_EQ((law * 0.5).at(2), 8.5);
}

TEST(NoiseModel, WhatIsWrongIsAllReported) {
  SensorModel model{NoiseShape::Gaussian, {0.01, 0, 0}, 0.5, 2};
  EXPECT_TRUE(validate(model).empty());
  model.far = 0.5, model.noise.constant = 0;
  EXPECT_EQ(validate(model).size(), 2u);
  model.far = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(validate(model).size(), 2u);
}

TEST(JudgedView, BelievingLeavesDepthsAloneAndGivesEveryPixelTheSameDoubt) {
  View view;
  view.name = "a", view.projection = Pinhole{3, 2, 2, 2, 1, 0.5, {}};
  view.world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  view.map.depth = Image<float>(3, 2, 1.5f);
  const JudgedViews judged = believe({view, view}, {}, 0.25);
  ASSERT_EQ(judged.views.size(), 2u);
  EXPECT_EQ(judged.views[1].name, "a");
  EXPECT_EQ(judged.views[1].world_from_camera.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(judged.views[1].depth, view.map.depth);
  EXPECT_EQ(judged.views[1].outlier, Image<float>(3, 2, 0.25f));
  EXPECT_EQ(judged.views[1].look, Image<Look>(3, 2, Look::Nothing));
  EXPECT_EQ(judged.views[1].weight, 1.0);
}

TEST(JudgedView, LookingUpANearestPixelCostsFourTenthsOfAPixel) {
  const Pinhole camera{640, 480, 500, 500, 320, 240, {}};
  const SensorModel sensor{NoiseShape::Gaussian, {0.003, 0, 0}, 0.1, 10};
  EXPECT_NEAR(lookupNoise(sensor, camera, 5), 0.005, 1e-12);  // 0.4 · 5/500 = 0.004
}

}  // namespace
}  // namespace vdbfuse
