// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/likelihood.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "fusion/likelihood_ratio.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

constexpr double kNear = 0.5, kFar = 2.5;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ∫ by Gauss–Legendre in panels.
template <class Function>
double integrate(const Function& function, double from, double to, int panels = 400) {
  constexpr double kNodes[] = {0.9061798459386640, 0.5384693101056831, 0.0};
  constexpr double kWeights[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889};
  double sum = 0;
  for (int p = 0; p < panels; ++p) {
    const double half = 0.5 * (to - from) / panels, middle = from + (2 * p + 1) * half;
    for (int k = 0; k < 3; ++k) {
      const double a = function(middle + half * kNodes[k]),
                   b = k < 2 ? function(middle - half * kNodes[k]) : 0;
      sum += half * kWeights[k] * (a + b);
    }
  }
  return sum;
}

double logisticDensity(double u) { return 0.25 / std::pow(std::cosh(u / 2), 2); }

// (a) of the Curless–Levoy proof: the closed form is Bayes' rule, for every case.
TEST(Likelihood, TheClosedFormIsTheBayesEvidenceByQuadrature) {
  const SensorModel sensor{logisticNoise(), {0.05, 0, 0}, kNear, kFar};
  for (const double outlier : {0.0, 0.01, 0.3}) {
    for (const double measured : {0.7, 1.3, 2.2}) {
      for (const double noise : {0.02, 0.05, 0.2}) {
        const auto density = [&](double truth) {
          return (1 - outlier) * logisticDensity((measured - truth) / noise) / noise +
                 outlier / (kFar - kNear);
        };
        for (double depth = 0.6; depth < 2.45; depth += 0.15) {
          // The density is smooth but narrow: panels as wide as the noise.
          const double seen = integrate(density, depth, kFar) / (kFar - depth);
          const double hidden = integrate(density, kNear, depth) / (depth - kNear);
          const double expected = std::log(seen / hidden);
          EXPECT_NEAR(logLikelihoodRatio(sensor, {measured, noise, outlier}, depth), expected,
                      1e-9 * (1 + std::abs(expected)))
              << outlier << " " << measured << " " << noise << " " << depth;
        }
      }
    }
  }
}

TEST(Likelihood, WithAnInfiniteRangeTheLogisticOddsAreTheDistanceItself) {
  const SensorModel sensor{logisticNoise(), {0.01, 0, 0}, -kInfinity, kInfinity};
  for (const double u : {0.0, 1e-3, 0.5, 3.0, 30.0, 1e3, 1e6}) {
    for (const double sign : {-1.0, 1.0}) {
      EXPECT_NEAR(logVisibleOdds(sensor, {0.0, 1.0, 0.0}, -sign * u), sign * u, 1e-12 * (1 + u));
    }
  }
}

// Integrated from 0, as the paper prints it, in place of −∞: e^(−d/w) is what it costs.
TEST(Likelihood, ARangeThatBeginsAtTheSensorChangesTheSumByExpOfMinusDepthOverScale) {
  const SensorModel from_zero{logisticNoise(), {1, 0, 0}, 0.0, kInfinity};
  for (const double d : {1.0, 2.0, 5.0, 20.0}) {
    for (const double measured : {d - 0.5, d, d + 3.0}) {
      const double difference = logVisibleOdds(from_zero, {measured, 1.0, 0.0}, d) - (measured - d);
      EXPECT_GT(difference, 0);
      EXPECT_NEAR(difference, -std::log1p(-std::exp(-d)) + 0.0, 2 * std::exp(-d) + 1e-12)
          << d << " " << measured;
    }
  }
}

TEST(Likelihood, IsStableWithoutOutliersAMillionScalesAway) {
  for (const NoiseShape& shape : {gaussianNoise(), logisticNoise(), laplaceNoise()}) {
    const SensorModel sensor{shape, {1e-6, 0, 0}, kNear, kFar};
    const double front = logLikelihoodRatio(sensor, {2.0, 1e-6, 0.0}, 1.0);
    const double behind = logLikelihoodRatio(sensor, {1.0, 1e-6, 0.0}, 2.0);
    EXPECT_TRUE(std::isfinite(front) && std::isfinite(behind)) << shape.name;
    // The tail's exponent, and prior odds below 7.
    const double exponent = shape.name == "gaussian" ? 0.5e12 : 1e6;
    EXPECT_NEAR(front / exponent, 1, 1e-4) << shape.name;
    EXPECT_NEAR(behind / exponent, -1, 1e-4) << shape.name;
  }
}

TEST(Likelihood, FallsWithDepthAndRisesWithTheMeasurement) {
  for (const NoiseShape& shape : {gaussianNoise(), logisticNoise(), laplaceNoise()}) {
    const SensorModel sensor{shape, {0.01, 0, 0}, kNear, kFar};
    double last = kInfinity;
    for (double depth = 0.55; depth < 2.45; depth += 0.01) {
      const double odds = logVisibleOdds(sensor, {1.5, 0.02, 0.05}, depth);
      EXPECT_LE(odds, last) << shape.name << " " << depth;
      last = odds;
    }
  }
}

TEST(Likelihood, ADecayingDepthPriorIsItsIntegral) {
  const double tau = 0.1, noise = 0.02, outlier = 0.05, measured = 1.3;
  const SensorModel sensor{logisticNoise(), {0.02, 0, 0}, kNear, kFar, tau};
  const auto density = [&](double truth) {
    return (1 - outlier) * logisticDensity((measured - truth) / noise) / noise + outlier / (kFar - kNear);
  };
  for (const double depth : {0.8, 1.25, 1.3, 1.35, 1.5, 2.0}) {
    const auto weighted = [&](double truth) { return density(truth) * std::exp(-(depth - truth) / tau); };
    const auto prior = [&](double truth) { return std::exp(-(depth - truth) / tau); };
    const double hidden = integrate(weighted, kNear, depth) / integrate(prior, kNear, depth);
    const double seen = integrate(density, depth, kFar) / (kFar - depth);
    EXPECT_NEAR(logLikelihoodRatio(sensor, {measured, noise, outlier}, depth), std::log(seen / hidden), 1e-6)
        << depth;
  }
}

TEST(Likelihood, FarBehindASurfaceADecayingDepthPriorLetsGo) {
  const SensorModel flat{gaussianNoise(), {0.01, 0, 0}, kNear, kFar, 0.0};
  const SensorModel thin{gaussianNoise(), {0.01, 0, 0}, kNear, kFar, 0.05};
  const Measurement wall(1.0, 0.01, 0.01);
  EXPECT_NEAR(logLikelihoodRatio(thin, wall, 0.8), logLikelihoodRatio(flat, wall, 0.8), 0.05);
  EXPECT_LT(logLikelihoodRatio(thin, wall, 1.04), -3);
  EXPECT_LT(logLikelihoodRatio(flat, wall, 2.0), -3);
  EXPECT_GT(logLikelihoodRatio(thin, wall, 2.0), -1);
}

TEST(Likelihood, TheTableKnowsTheDepthPriorToo) {
  for (const double tau : {0.02, 0.1, 1.0}) {
    const SensorModel sensor{gaussianNoise(), {0.01, 0, 0}, kNear, kFar, tau};
    const LikelihoodRatio table(sensor);
    Random random(3);
    for (int i = 0; i < 300; ++i) {
      const double noise = random.uniform(0.002, 0.03), outlier = random.uniform(0.003, 0.5);
      const float measured = static_cast<float>(random.uniform(kNear + 0.1, kFar - 0.1));
      const float depth = static_cast<float>(i % 2 == 0 ? measured + noise * random.uniform(-6, 6)
                                                        : random.uniform(kNear, kFar));
      EXPECT_NEAR(table.log(measured, static_cast<float>(noise), static_cast<float>(outlier), depth),
                  logLikelihoodRatio(sensor, {measured, noise, outlier}, depth), 2e-2)
          << tau << " " << noise << " " << (depth - measured) / noise;
    }
  }
}

TEST(Likelihood, TwoHypothesesAreAMixtureOfInliers) {
  const SensorModel sensor{gaussianNoise(), {0.01, 0, 0}, kNear, kFar};
  Measurement two(1.0, 0.01, 0.02);
  two.hypotheses[0].share = 0.7;
  two.hypotheses[1] = {1.8, 0.01, 0.3};
  two.count = 2;
  // Between them it is inside with the odds of the shares.
  const double t = 0.45, depth = kNear + t * (kFar - kNear);
  const double behind = (0.98 * 0.3 + 0.02 * (1 - t)) / (1 - t), before = (0.98 * 0.7 + 0.02 * t) / t;
  EXPECT_NEAR(logLikelihoodRatio(sensor, two, depth), std::log(behind / before), 1e-9);
  EXPECT_GT(logLikelihoodRatio(sensor, two, 0.8), 3);
  EXPECT_LT(logLikelihoodRatio(sensor, two, 2.2), -3);
}

// (c) of the proof: Curless–Levoy's truncation is an outlier model, T = w log((2 − ε)/ε) at the middle of the
// range.
TEST(Likelihood, TheOutlierShareSetsTheTruncation) {
  for (const double outlier : {0.001, 0.01, 0.1}) {
    const SensorModel sensor{logisticNoise(), {0.002, 0, 0}, kNear, kFar};
    const double middle = 0.5 * (kNear + kFar), w = 0.002, truncation = std::log((2 - outlier) / outlier);
    const auto at = [&](double u) { return logVisibleOdds(sensor, {middle + u * w, w, outlier}, middle); };
    EXPECT_NEAR(at(200), truncation, 1e-6);
    EXPECT_NEAR(at(-200), -truncation, 1e-6);
    EXPECT_NEAR(at(0.2 * truncation), 0.2 * truncation, 0.05 * truncation);
    EXPECT_LT(at(truncation), 0.95 * truncation);
  }
}

}  // namespace
}  // namespace vdbfuse
