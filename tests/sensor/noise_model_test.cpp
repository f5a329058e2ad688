// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/noise_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {
namespace {

const NoiseShape kShapes[] = {gaussianNoise(), logisticNoise(), laplaceNoise()};

TEST(NoiseModel, TheCdfIsTheIntegralOfItsDensity) {
  const auto density = [](const NoiseShape& shape, double u) {
    if (shape.name == "gaussian") return std::exp(-u * u / 2) / std::sqrt(2 * std::numbers::pi);
    if (shape.name == "laplace") return 0.5 * std::exp(-std::abs(u));
    return 0.25 / std::pow(std::cosh(u / 2), 2);
  };
  for (const NoiseShape& shape : kShapes) {
    for (double u = -4; u < 4; u += 0.5) {
      constexpr int kSteps = 100;
      double integral = 0;  // by Simpson's rule
      for (int i = 0; i <= kSteps; ++i)
        integral += (i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2) * density(shape, u + 0.5 * i / kSteps);
      integral *= 0.5 / kSteps / 3;
      EXPECT_NEAR(shape.cdf(u + 0.5) - shape.cdf(u), integral, 1e-9);
    }
  }
}

TEST(NoiseModel, TheCdfIsSymmetricAndAccurateInItsTails) {
  for (const NoiseShape& shape : kShapes) {
    EXPECT_DOUBLE_EQ(shape.cdf(0), 0.5);
    EXPECT_EQ(shape.cdf(-std::numeric_limits<double>::infinity()), 0);
    EXPECT_EQ(shape.cdf(std::numeric_limits<double>::infinity()), 1);
    for (const double u : {0.3, 2.0, 8.0}) EXPECT_NEAR(shape.cdf(u) + shape.cdf(-u), 1, 1e-15);
  }
  EXPECT_NEAR(gaussianNoise().cdf(-10) / 7.619853024160527e-24, 1, 1e-12);
  EXPECT_NEAR(logisticNoise().cdf(-100) / std::exp(-100.0), 1, 1e-12);
  EXPECT_NEAR(laplaceNoise().cdf(-100) / (0.5 * std::exp(-100.0)), 1, 1e-12);
}

TEST(NoiseModel, LogarithmsAreRightAMillionScalesAway) {
  const double u = 1e6;
  EXPECT_DOUBLE_EQ(logisticNoise().logCdf(-u), -u);
  EXPECT_DOUBLE_EQ(laplaceNoise().logCdf(-u), -u - std::log(2.0));
  EXPECT_NEAR(gaussianNoise().logCdf(-u) / (-0.5 * u * u), 1, 1e-9);
  // Where the series takes over from erfc both agree.
  EXPECT_NEAR(gaussianNoise().logCdf(-34.999999), gaussianNoise().logCdf(-35.000001), 1e-4);
  // By the continued fraction of Mills' ratio, to 50 digits.
  EXPECT_NEAR(gaussianNoise().logCdf(-36), -652.503227593798, 1e-9);
  for (const NoiseShape& shape : kShapes) {
    EXPECT_EQ(shape.logSurvival(u), shape.logCdf(-u)) << shape.name;
    EXPECT_NEAR(shape.logBetween(-u, u), 0, 1e-15) << shape.name;
    EXPECT_TRUE(std::isfinite(shape.logBetween(u, u + 1))) << shape.name;
  }
}

TEST(NoiseModel, TheLogarithmOfAnIntervalIsThatOfTheDifference) {
  for (const NoiseShape& shape : kShapes) {
    for (double a = -5; a < 5; a += 0.7) {
      for (const double width : {1e-3, 0.5, 3.0}) {
        const double b = a + width;
        // On the lower side, where the plain difference keeps its digits.
        const double low = a + b > 0 ? -b : a, high = a + b > 0 ? -a : b;
        EXPECT_NEAR(shape.logBetween(a, b), std::log(shape.cdf(high) - shape.cdf(low)), 1e-11) << shape.name;
      }
    }
    EXPECT_EQ(shape.logBetween(1, 1), -std::numeric_limits<double>::infinity());
    EXPECT_EQ(shape.logBetween(2, 1), -std::numeric_limits<double>::infinity());
  }
}

TEST(NoiseModel, AModelOfYourOwnIsItsCdf) {
  // Cauchy's, with tails like few others.
  const NoiseShape cauchy =
      NoiseShape::fromCdf("cauchy", [](double u) { return 0.5 + std::atan(u) / std::numbers::pi; });
  EXPECT_DOUBLE_EQ(cauchy.cdf(1), 0.75);
  EXPECT_DOUBLE_EQ(std::exp(cauchy.logSurvival(1)), 0.25);
  EXPECT_NEAR(std::exp(cauchy.logBetween(-1, 1)), 0.5, 1e-12);
}

TEST(NoiseModel, ShapesAndSensorsAreFoundByNameAndTheNamesAreListedOtherwise) {
  EXPECT_EQ(noiseShape("laplace").name, "laplace");
  EXPECT_THROW(noiseShape("gauss"), InvalidArgument);
  for (const SensorPreset& preset : sensorPresets()) {
    EXPECT_EQ(sensorPreset(preset.name).noise, preset.noise);
    EXPECT_GT(preset.noise.at(0.5), 0) << preset.name;
    EXPECT_LT(preset.noise.at(1), 0.01 + 0.02) << preset.name;
  }
  try {
    sensorPreset("konect");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("kinect"), std::string::npos) << error.what();
  }
}

TEST(NoiseModel, TheLawsOfSensorsAreWhatTheirPhysicsSays) {
  EXPECT_DOUBLE_EQ(NoiseLaw::stereo(500, 0.1, 0.25).at(2), 0.02);
  EXPECT_DOUBLE_EQ(NoiseLaw::structuredLight().at(1.4), 0.0031);
  // Nearer than the vertex of its parabola it does not grow again.
  EXPECT_DOUBLE_EQ(NoiseLaw::structuredLight().at(0.1), NoiseLaw::structuredLight().at(0.4));
  // The same sensor in millimetres.
  EXPECT_DOUBLE_EQ(NoiseLaw::structuredLight(1000).at(1400), 3.1);
  EXPECT_DOUBLE_EQ(NoiseLaw::timeOfFlight(1000).at(2000), 1000 * NoiseLaw::timeOfFlight().at(2));
  EXPECT_THROW(NoiseLaw::stereo(500, 0, 0.25), InvalidArgument);
}

TEST(NoiseModel, TheLawIsAPolynomialOfTheDepth) {
  const NoiseLaw law{1, 2, 3};
  EXPECT_DOUBLE_EQ(law.at(2), 17);
  EXPECT_DOUBLE_EQ((law * 0.5).at(2), 8.5);
}

TEST(NoiseModel, WhatIsWrongIsAllReported) {
  SensorModel model{gaussianNoise(), {0.01, 0, 0}, 0.5, 2};
  EXPECT_TRUE(validate(model).empty());
  model.far = 0.5, model.noise.constant = 0;
  EXPECT_EQ(validate(model).size(), 2u);
  model.far = std::numeric_limits<double>::quiet_NaN();
  model.prior_decay = -1;
  EXPECT_EQ(validate(model).size(), 3u);
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
  const SensorModel sensor{gaussianNoise(), {0.003, 0, 0}, 0.1, 10};
  EXPECT_NEAR(lookupNoise(sensor, camera, 5), 0.005, 1e-12);  // 0.4 · 5/500 = 0.004
}

}  // namespace
}  // namespace vdbfuse
