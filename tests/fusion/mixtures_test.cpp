// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fusion/half_normal.h"
#include "fusion/two_class_em.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

TEST(HalfNormal, TheScaleIsRecoveredUnderAFifthOfUniformOutliers) {
  for (const double scale : {1e-4, 0.01, 3.0}) {
    Random random(1);
    std::vector<double> values;
    for (int i = 0; i < 20000; ++i)
      values.push_back(random.uniform() < 0.2 ? random.uniform(0, 15 * scale)
                                              : scale * std::abs(random.normal()));
    const HalfNormalFit fit = fitHalfNormal(values);
    EXPECT_NEAR(fit.scale, scale, 0.03 * scale);
    EXPECT_NEAR(fit.inlier_share, 0.8, 0.03);
  }
}

TEST(HalfNormal, WithoutOutliersItIsTheRootMeanSquare) {
  Random random(2);
  std::vector<double> values;
  double squares = 0;
  for (int i = 0; i < 5000; ++i) {
    values.push_back(std::abs(random.normal()));
    squares += values.back() * values.back();
  }
  EXPECT_NEAR(fitHalfNormal(values).scale, std::sqrt(squares / 5000), 0.02);
}

TEST(HalfNormal, ValuesThatAreAllEqualOrZeroGiveAFiniteFit) {
  for (const double value : {0.0, 1.0}) {
    const HalfNormalFit fit = fitHalfNormal(std::vector<double>(100, value));
    EXPECT_TRUE(std::isfinite(fit.scale) && std::isfinite(fit.log_likelihood)) << value;
    EXPECT_NEAR(fit.scale, value, 0.01);
  }
}

TEST(HalfNormal, TheLikelihoodPrefersTheRightScaling) {
  // Noise that grows with depth: dividing by the depth makes it one half-normal.
  Random random(3);
  std::vector<double> raw, divided;
  double jacobian = 0;
  for (int i = 0; i < 5000; ++i) {
    const double depth = random.uniform(0.5, 2), value = std::abs(0.01 * depth * random.normal());
    raw.push_back(value), divided.push_back(value / depth);
    jacobian -= std::log(depth);
  }
  EXPECT_GT(fitHalfNormal(divided).log_likelihood + jacobian, fitHalfNormal(raw).log_likelihood + 50);
}

// Two observations of three and four values. Each class has values of its own in both: without them two
// observations do not determine a mixture.
struct Planted {
  double share = 0.25;
  std::array<double, 3> good_a = {0, 0.3, 0.7}, bad_a = {0.7, 0.3, 0};
  std::array<double, 4> good_b = {0, 0.2, 0.3, 0.5}, bad_b = {0.7, 0.2, 0.1, 0};
  double bad(std::size_t a, std::size_t b) const { return share * bad_a.at(a) * bad_b.at(b); }
  double good(std::size_t a, std::size_t b) const { return (1 - share) * good_a.at(a) * good_b.at(b); }
};

TEST(TwoClassEm, APlantedModelIsRecoveredFromItsExpectedCounts) {
  const Planted truth;
  JointCounts joint({3, 4});
  std::vector<double> start;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 4; ++b) {
      joint.counts[joint.index(std::array{a, b})] = 1e6 * (truth.good(a, b) + truth.bad(a, b));
      start.push_back(a >= 1 && b >= 2 ? 0.0 : 1.0);
    }
  const TwoClassModel model = fitTwoClasses(joint, start);
  EXPECT_NEAR(model.outlier_share, truth.share, 0.02);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(model.inlier[0][a], truth.good_a.at(a), 0.03);
    for (std::size_t b = 0; b < 4; ++b) {
      const double all = truth.bad(a, b) + truth.good(a, b);
      if (all > 0) {
        EXPECT_NEAR(model.outlierGiven(std::array{a, b}), truth.bad(a, b) / all, 0.05);
      }
    }
  }
}

TEST(TwoClassEm, EveryStepEndsInProbabilities) {
  JointCounts joint({2, 2});
  joint.counts = {0, 0, 0, 100};
  const TwoClassModel model = fitTwoClasses(joint, {1, 1, 1, 0});
  EXPECT_LT(model.outlierGiven(std::array<std::size_t, 2>{1, 1}), 0.05);
  for (std::size_t k = 0; k < 4; ++k) {
    const double p = model.outlierGiven(std::array{k / 2, k % 2});
    EXPECT_TRUE(p > 0 && p < 1);
  }
}

TEST(JointCounts, IndexAndValuesAreInverse) {
  const JointCounts joint({3, 4, 5});
  ASSERT_EQ(joint.counts.size(), 60u);
  for (std::size_t k = 0; k < 60; ++k) EXPECT_EQ(joint.index(joint.values(k)), k);
}

}  // namespace
}  // namespace vdbfuse
