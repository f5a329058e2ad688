// SPDX-License-Identifier: Apache-2.0
#include "fusion/visibility_integral.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace vdbfuse {
namespace {

struct Testimony {
  double log_ratio, count;
};

// log ∫ Beta(v; a, 1) Π (1 − v + v L)^n dv with v = u^(1/a), by very many midpoints.
double exactly(double a, const std::vector<Testimony>& all) {
  constexpr int kSteps = 400000;
  std::vector<double> logs;
  double largest = -1e300;
  for (int i = 0; i < kSteps; ++i) {
    const double v = std::pow((i + 0.5) / kSteps, 1 / a);
    double sum = 0;
    for (const Testimony& t : all) sum += t.count * std::log1p(v * std::expm1(t.log_ratio));
    logs.push_back(sum);
    largest = std::max(largest, sum);
  }
  double sum = 0;
  for (const double l : logs) sum += std::exp(l - largest);
  return largest + std::log(sum / kSteps);
}

double byIntegral(double a, const std::vector<Testimony>& all) {
  double views = 0;
  for (const Testimony& t : all) views += t.count;
  const VisibilityIntegral integral(a, 0.0, views);
  std::vector<float> sums(static_cast<std::size_t>(integral.nodeCount()), 0.0f);
  for (const Testimony& t : all)
    for (int i = 0; i < t.count; ++i) integral.add(static_cast<float>(t.log_ratio), 1.0f, sums.data());
  return integral.logMean(sums.data());
}

TEST(VisibilityIntegral, IsTheExactIntegralForOneToEightHundredViews) {
  for (const double a : {0.25, 0.5}) {
    for (const double n : {1.0, 8.0, 72.0, 800.0}) {
      const std::vector<Testimony> denials = {{-5.0, n}};
      EXPECT_NEAR(byIntegral(a, denials), exactly(a, denials), 0.2) << a << " " << n;
      const std::vector<Testimony> agreements = {{5.0, n}};
      // Far above where evidence is clamped: a share of it is enough.
      EXPECT_NEAR(byIntegral(a, agreements), exactly(a, agreements), 0.2 + 0.06 * exactly(a, agreements))
          << a << " " << n;
      const std::vector<Testimony> mixed = {{-4.0, n}, {5.0, std::ceil(n / 20)}};
      EXPECT_NEAR(byIntegral(a, mixed), exactly(a, mixed), 1.0) << a << " " << n;
    }
  }
  for (const double n : {1.0, 8.0, 72.0}) {
    const std::vector<Testimony> denials = {{-5.0, n}};
    EXPECT_NEAR(byIntegral(1.0, denials), exactly(1.0, denials), 0.2) << n;
  }
}

TEST(VisibilityIntegral, ADenialsWeightGrowsWithTheLogarithmOfTheirNumberOnly) {
  const double few = byIntegral(0.5, {{-8.0, 8}}), many = byIntegral(0.5, {{-8.0, 800}});
  EXPECT_NEAR(few - many, 0.5 * std::log(100.0), 0.3);
}

TEST(VisibilityIntegral, HalfADenialIsTheClosedForm) {
  for (const double a : {0.25, 0.5, 1.0, 2.0}) {
    const VisibilityIntegral integral(a, 0.0, 72);
    for (const int n : {0, 1, 8, 72}) {
      const std::vector<Testimony> certain = {{-60.0, static_cast<double>(n)}};
      EXPECT_NEAR(integral.halfDenial(n), -0.5 * exactly(a, certain), 2e-3) << a << " " << n;
    }
    EXPECT_NEAR(integral.halfDenial(3.5), 0.5 * (integral.halfDenial(3) + integral.halfDenial(4)), 1e-12);
    EXPECT_GE(integral.halfDenial(1e9), integral.halfDenial(72));
  }
  // a = 1: ∫ (1 − v)ⁿ dv = 1/(n + 1).
  EXPECT_NEAR(VisibilityIntegral(1.0, 0.0, 10).halfDenial(9), 0.5 * std::log(10.0), 1e-12);
}

TEST(VisibilityIntegral, OneVisibilityIsThePlainSum) {
  const VisibilityIntegral integral(0.5, 0.05, 100);
  ASSERT_EQ(integral.nodeCount(), 1);
  float sum = 0;
  double expected = 0;
  for (int i = 0; i < 100; ++i) {
    const double log_ratio = -15.9 + 0.31 * i;
    integral.add(static_cast<float>(log_ratio), 0.5f, &sum);
    expected += 0.5 * std::log1p(0.05 * std::expm1(log_ratio));
  }
  EXPECT_NEAR(integral.logMean(&sum), expected, 100 * 0.5 * 4e-4);
}

TEST(VisibilityIntegral, WhatWasAddedCanBeTakenAway) {
  const VisibilityIntegral integral(0.5, 0.0, 20);
  std::vector<float> sums(static_cast<std::size_t>(integral.nodeCount()), 0.0f);
  integral.add(-3.0f, 1.0f, sums.data());
  const std::vector<float> before = sums;
  integral.add(4.7f, 0.3f, sums.data());
  EXPECT_NE(sums, before);
  integral.add(4.7f, -0.3f, sums.data());
  for (std::size_t k = 0; k < sums.size(); ++k) EXPECT_NEAR(sums[k], before[k], 1e-6);
}

}  // namespace
}  // namespace vdbfuse
