// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "fusion/half_normal.h"
#include "fusion/outlier_em.h"
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

// Pixels of two kinds with different shares of outliers. The neighbours' answer is three-valued; of the
// confidence's two bins outliers prefer the lower one.
struct Planted {
  std::array<double, 2> share = {0.02, 0.6};
  std::array<double, 3> good = {0.1, 0.2, 0.7}, bad = {0.7, 0.25, 0.05};
  std::array<double, 2> good_confidence = {0.3, 0.7}, bad_confidence = {0.8, 0.2};

  std::vector<OutlierCell> cells(double sharpness = 1.0) const {
    std::vector<OutlierCell> result;
    for (std::size_t kind = 0; kind < 2; ++kind)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t c = 0; c < 2; ++c) {
          const double wrong = share.at(kind) * bad.at(a) * bad_confidence.at(c);
          const double right = (1 - share.at(kind)) * good.at(a) * good_confidence.at(c);
          result.push_back({1e6 * (wrong + right), std::pow(bad.at(a) / good.at(a), sharpness), kind, c});
        }
    return result;
  }
};

TEST(OutlierEm, PlantedSharesAndConfidencesAreRecovered) {
  const Planted truth;
  const OutlierModel model = fitOutliers(truth.cells(), 2, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(model.share_by_kind[i], truth.share.at(i), 0.01);
    EXPECT_NEAR(model.confidence_ratio[i], truth.bad_confidence.at(i) / truth.good_confidence.at(i), 0.05);
  }
}

TEST(OutlierEm, RatiosKnownRoughlyAreEnough) {
  const Planted truth;
  for (const double sharpness : {0.75, 1.4}) {
    const OutlierModel model = fitOutliers(truth.cells(sharpness), 2, 2);
    EXPECT_LT(model.share_by_kind[0], 0.08) << sharpness;
    EXPECT_NEAR(model.share_by_kind[1], 0.6, 0.1) << sharpness;
  }
}

TEST(OutlierEm, WhereNothingSpeaksAgainstThereAreNoOutliers) {
  // Most pixels of few clean views are seen by nobody else.
  const OutlierModel model = fitOutliers({{9e5, 1.0, 0, 0}, {1e5, 0.05, 0, 0}, {100, 50.0, 0, 0}}, 1, 1);
  EXPECT_LT(model.share_by_kind[0], 0.02);
  EXPECT_LT(model.outlierGiven(1.0, 0, 0), 0.02);
}

TEST(OutlierEm, WithoutPixelsEverythingIsAProbability) {
  const OutlierModel model = fitOutliers({}, 3, 2);
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = model.outlierGiven(200.0, k, k % 2);
    EXPECT_TRUE(p > 0 && p < 1);
  }
}

}  // namespace
}  // namespace vdbfuse
