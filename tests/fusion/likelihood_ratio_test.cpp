// SPDX-License-Identifier: Apache-2.0
#include "fusion/likelihood_ratio.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vdbfuse/base/random.h"
#include "vdbfuse/fusion/evidence.h"
#include "vdbfuse/fusion/likelihood.h"

namespace vdbfuse {
namespace {

const NoiseShape kShapes[] = {gaussianNoise(), logisticNoise(), laplaceNoise()};
constexpr double kNear = 0.5, kFar = 2.5;

SensorModel sensorOf(const NoiseShape& shape) { return {shape, {0.01, 0, 0}, kNear, kFar}; }

TEST(LikelihoodRatio, TheTableAgreesWithTheFormula) {
  for (const NoiseShape& shape : kShapes) {
    const SensorModel sensor = sensorOf(shape);
    const LikelihoodRatio table(sensor);
    Random random(1);
    for (int i = 0; i < 20000; ++i) {
      const double noise = random.uniform(0.002, 0.05), outlier = random.uniform(0.003, 0.99);
      const double measured = static_cast<float>(random.uniform(kNear, kFar));
      const double depth = static_cast<float>(i % 2 == 0 ? measured + noise * random.uniform(-6, 6)
                                                         : random.uniform(kNear, kFar));
      const double exact = logLikelihoodRatio(sensor, {measured, noise, outlier}, depth);
      ASSERT_NEAR(table.log(static_cast<float>(measured), static_cast<float>(noise),
                            static_cast<float>(outlier), static_cast<float>(depth)),
                  exact, 2e-3)
          << shape.name << ", " << (depth - measured) / noise << " scales behind";
    }
  }
}

TEST(LikelihoodRatio, InFrontOfTheMeasurementAndBehindItTheOutliersSetTheLimit) {
  for (const NoiseShape& shape : kShapes) {
    for (const double outlier : {0.003, 0.1}) {
      const SensorModel sensor = sensorOf(shape);
      const double measured = 1.5;
      for (const double depth : {0.7, 1.0, 1.2}) {
        const double t = (depth - kNear) / (kFar - kNear);
        EXPECT_NEAR(logLikelihoodRatio(sensor, {measured, 0.01, outlier}, depth),
                    std::log((1 - outlier * t) / (outlier * (1 - t))), 1e-6);
      }
      for (const double depth : {1.8, 2.0, 2.3}) {
        const double t = (depth - kNear) / (kFar - kNear);
        EXPECT_NEAR(logLikelihoodRatio(sensor, {measured, 0.01, outlier}, depth),
                    -std::log((1 - outlier * (1 - t)) / (outlier * t)), 1e-6);
      }
    }
  }
}

TEST(LikelihoodRatio, IsTheRatioOfTheTwoIntegralsOverWhereTheSurfaceMayBe) {
  // p(D | seen past x) = mean of p(D | D*) over D* in [d, far], p(D | not) over [near, d], by midpoints.
  const SensorModel sensor = sensorOf(logisticNoise());
  const double noise = 0.05, outlier = 0.05, measured = 1.3;
  const auto density = [&](double truth) {
    const double u = (measured - truth) / noise;
    return (1 - outlier) * 0.25 / std::pow(std::cosh(u / 2), 2) / noise + outlier / (kFar - kNear);
  };
  const auto mean = [&](double from, double to) {
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += density(from + (to - from) * (i + 0.5) / kSteps);
    return sum / kSteps;
  };
  for (const double depth : {0.7, 1.1, 1.25, 1.3, 1.35, 1.5, 2.2}) {
    EXPECT_NEAR(logLikelihoodRatio(sensor, {measured, noise, outlier}, depth),
                std::log(mean(depth, kFar) / mean(kNear, depth)), 1e-5);
  }
}

// Equation (11), one sensor: logistic noise, no outliers. With t/(1 − t), the flat prior's part, taken away
// what is left is (D − d)/w, up to what the ends of [near, far] cut off, e^(−20) here.
TEST(LikelihoodRatio, WithLogisticNoiseAndNoOutliersIsTheCurlessLevoyTermTimesThePriorOdds) {
  const SensorModel sensor = sensorOf(logisticNoise());
  const double noise = 0.02;
  for (double u = -8; u <= 8; u += 0.5) {
    const double measured = 1.4, depth = measured - u * noise, t = (depth - kNear) / (kFar - kNear);
    EXPECT_NEAR(logLikelihoodRatio(sensor, {measured, noise, 0.0}, depth) - std::log(t / (1 - t)), u, 1e-5);
  }
}

TEST(LikelihoodRatio, OutliersTruncateTheSum) {
  // Saturates at ± log((2 − ε)/ε) where t = ½, and is linear well below it.
  SensorModel sensor = sensorOf(logisticNoise());
  const double outlier = 0.01, limit = std::log((2 - outlier) / outlier);
  const auto at = [&](double u) {
    return logLikelihoodRatio(sensor, {1.5 + u * 0.005, 0.005, outlier}, 1.5);
  };
  EXPECT_NEAR(at(100), limit, 1e-6);
  EXPECT_NEAR(at(-100), -limit, 1e-6);
  EXPECT_NEAR(at(1), 1, 0.03);
  EXPECT_LT(at(limit), 0.9 * limit);
}

TEST(LikelihoodRatio, ALookThatMetNothingSaysLittle) {
  EXPECT_NEAR(logNoReturnRatio(0.2), std::log(3.0), 1e-12);
  EXPECT_EQ(logNoReturnRatio(0.01), logNoReturnRatio(0.2));
  EXPECT_NEAR(logNoReturnRatio(1.0), 0, 1e-12);
}

}  // namespace
}  // namespace vdbfuse
