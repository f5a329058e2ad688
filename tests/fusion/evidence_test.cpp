// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/evidence.h"

#include <gtest/gtest.h>

#include <limits>

#include <algorithm>

#include "fusion/scenes.h"
#include "octree/random_octree.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {
namespace {

using Points = std::vector<Eigen::Vector3d>;

JudgedViews sphere(int views = 24, double outlier = 0.05) {
  return believe(test::sphereViews(views), test::sphereSensor(), outlier);
}

Points pointsAt(double radius, int count = 40) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(radius * test::fibonacciDirection(i, count));
  return points;
}

Points randomPoints(int count, std::uint64_t seed = 1) {
  Random random(seed);
  Points points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6));
  return points;
}

EvidenceOptions rule(EvidenceRule rule) {
  EvidenceOptions options;
  options.rule = rule;
  return options;
}

class EveryRule : public testing::TestWithParam<EvidenceRule> {};
INSTANTIATE_TEST_SUITE_P(Rules, EveryRule,
                         testing::Values(EvidenceRule::Outside, EvidenceRule::Paper,
                                         EvidenceRule::NoSelfOcclusion));

TEST_P(EveryRule, TheOrderOfTheViewsDoesNotMatter) {
  JudgedViews judged = sphere();
  Random random(2);
  for (JudgedView& view : judged.views) {
    view.weight = random.uniform(0.2, 1);
    view.look = Image<Look>(64, 64, Look::Empty);
  }
  const Points points = randomPoints(300);
  const std::vector<float> expected = evidenceAt(judged, points, rule(GetParam()));
  std::reverse(judged.views.begin(), judged.views.end());
  const std::vector<float> reversed = evidenceAt(judged, points, rule(GetParam()));
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_NEAR(reversed[i], expected[i], 1e-3 * (1 + std::abs(expected[i])));
}

TEST_P(EveryRule, APointInFrontOfASphereIsOutsideUnlessEverySensorMustSeeIt) {
  // Without self-occlusion the sensors on the far side deny it, and they are more.
  for (const float e : evidenceAt(sphere(), pointsAt(0.54), rule(GetParam())))
    EXPECT_EQ(e > 0, GetParam() != EvidenceRule::NoSelfOcclusion);
}

TEST_P(EveryRule, TheInteriorOfAClosedSphereIsNeverVisible) {
  for (const double radius : {0.0, 0.2, 0.45})
    for (const float e : evidenceAt(sphere(), pointsAt(radius), rule(GetParam()))) EXPECT_LT(e, 0) << radius;
}

TEST_P(EveryRule, IsTheSameForAnyNumberOfPointsAtATime) {
  const Points points = randomPoints(1200);
  const JudgedViews judged = sphere(6);
  const std::vector<float> all = evidenceAt(judged, points, rule(GetParam()));
  for (const std::size_t i : {0u, 511u, 512u, 1199u})
    EXPECT_NEAR(evidenceAt(judged, {points[i]}, rule(GetParam())).front(), all[i],
                1e-3 * (1 + std::abs(all[i])));
}

TEST(Evidence, BehindAWallThatOneSensorSeesIsInsideInFrontOfItOutside) {
  const Pinhole camera{40, 40, 60, 60, 19.5, 19.5, {}};
  const View view = test::castView({0, 0, 2}, {0, 0, 0}, camera, test::planeCaster(0));
  const JudgedViews judged = believe({view}, {gaussianNoise(), {0.01, 0, 0}, 1, 3}, 0.01);
  const std::vector<float> e = evidenceAt(judged, {{0, 0, 0.5}, {0, 0, 0.1}, {0, 0, -0.1}, {0, 0, -0.5}}, {});
  EXPECT_GT(e[0], 0);
  EXPECT_GT(e[1], 0);
  EXPECT_LT(e[2], 0);
  EXPECT_LT(e[3], 0);
  // Where nobody looks only the prior is left.
  EXPECT_FLOAT_EQ(evidenceAt(judged, {{50, 0, 0}}, {}).front(), 0.0f);
}

TEST(Evidence, RepeatedViewsWithSharedWeightsCountOnce) {
  for (const bool no_return : {false, true}) {
    JudgedViews once = sphere(8);
    if (no_return)
      for (JudgedView& view : once.views) view.look = Image<Look>(64, 64, Look::Empty);
    JudgedViews tripled = once;
    tripled.views.clear();
    for (const JudgedView& view : once.views)
      for (int k = 0; k < 3; ++k) tripled.views.push_back(view), tripled.views.back().weight = 1.0 / 3;
    const Points points = randomPoints(500);
    const std::vector<float> expected = evidenceAt(once, points, {}), found = evidenceAt(tripled, points, {});
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_NEAR(found[i], expected[i], 2e-3) << no_return;
  }
}

TEST(Evidence, NoReturnsSpeakForOutsideButOnlyAFewOfThem) {
  JudgedViews judged = sphere(24);
  const Points aside = {{0.9, 0, 0}};
  const float without = evidenceAt(judged, aside, {}).front();
  for (JudgedView& view : judged.views) {
    view.depth = Image<float>(64, 64, kInvalidDepth);
    view.projection = test::cameraFor(64, 1.2, 2);
    view.look = Image<Look>(64, 64, Look::Empty);
  }
  EvidenceOptions options;
  const float four = evidenceAt(judged, aside, options).front();
  EXPECT_GT(four, without);
  options.max_no_returns = 24;
  EXPECT_GT(evidenceAt(judged, aside, options).front(), four + 1);
  options.max_no_returns = 0;
  EXPECT_NEAR(evidenceAt(judged, aside, options).front(), 0.0f, 1e-6f);
}

// Views of a sphere in which the first `count` have masks that call everything background.
JudgedViews wronglyMasked(int views, std::size_t count) {
  JudgedViews judged = sphere(views, kMinOutlier);
  for (std::size_t i = 0; i < count; ++i) judged.views[i].look = Image<Look>(64, 64, Look::Outside);
  return judged;
}

TEST_P(EveryRule, APixelOutsideTheMaskIsFreeAlongItsWholeRayWhateverItMeasured) {
  JudgedViews with_depth = wronglyMasked(4, 4), without = with_depth;
  for (JudgedView& view : without.views) view.depth = Image<float>(64, 64, kInvalidDepth);
  const Points points = pointsAt(0.4);
  const std::vector<float> e = evidenceAt(with_depth, points, rule(GetParam()));
  EXPECT_EQ(e, evidenceAt(without, points, rule(GetParam())));
  const std::vector<float> unmasked = evidenceAt(wronglyMasked(4, 0), points, rule(GetParam()));
  for (std::size_t i = 0; i < e.size(); ++i) {
    EXPECT_GT(e[i], unmasked[i]);
    EXPECT_TRUE(e[i] > 0 || GetParam() == EvidenceRule::Paper);
  }
}

TEST(Evidence, TwoMasksCarveWhatTheOtherViewsDoNotSeeAndMoreOfThemMore) {
  float last = -100;
  for (const std::size_t masks : {0u, 1u, 2u, 4u}) {
    const float e = evidenceAt(wronglyMasked(6, masks), {{0, 0, 0}}, {}).front();
    EXPECT_GT(e, last) << masks;
    last = e;
  }
  EXPECT_GT(last, 0);
}

TEST(Evidence, OneWrongMaskOrAnyNumberOfItsCopiesCannotCarveWhatTwoViewsDeny) {
  for (const int views : {3, 6, 12, 24}) {
    JudgedViews judged = wronglyMasked(views, 1);
    EXPECT_LT(evidenceAt(judged, {{0, 0, 0}}, {}).front(), 0) << views;
    judged.views.front().weight = 0.1;
    for (int copy = 1; copy < 10; ++copy) judged.views.push_back(judged.views.front());
    EXPECT_LT(evidenceAt(judged, {{0, 0, 0}}, {}).front(), 0) << views;
  }
}

TEST(Evidence, AMaskIsAsStrongAsItIsSeldomWrong) {
  EXPECT_NEAR(std::exp(logMaskRatio(0.02)), 25, 1e-9);
  EXPECT_NEAR(logMaskRatio(0.4999), 0, 1e-3);
  EXPECT_GT(logMaskRatio(0.01), logMaskRatio(0.02));
}

// π_i and eq. (5) as printed.
TEST(Evidence, ThePapersRuleIsTheLogOddsOfTheDirectProduct) {
  const JudgedViews judged = sphere(6, 0.1);
  const SensorModel& sensor = judged.sensor;
  const Points points = randomPoints(400);
  const std::vector<float> found = evidenceAt(judged, points, rule(EvidenceRule::Paper));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].norm() > 0.65) continue;  // outside [near, far] nothing holds
    double product = 1;
    bool reported = false;
    for (const JudgedView& view : judged.views) {
      const auto seen = Projector(view.projection, view.world_from_camera)(points[i]);
      if (!seen || view.depth(seen->x, seen->y) == kInvalidDepth) continue;
      const double measured = view.depth(seen->x, seen->y), e = view.outlier(seen->x, seen->y);
      const double s = lookupNoise(sensor, view.projection, measured);
      const double t = (seen->depth - sensor.near) / (sensor.far - sensor.near);
      const auto cdf = [&](double d) { return sensor.shape.cdf((d - measured) / s); };
      product *= ((1 - e) * (cdf(seen->depth) - cdf(sensor.near)) + e * t) /
                 ((1 - e) * (cdf(sensor.far) - cdf(sensor.near)) + e);
      reported = true;
    }
    const double expected = reported ? std::log((1 - product) / product) : EvidenceOptions().prior;
    ASSERT_NEAR(found[i], expected, 5e-3) << i;
  }
}

// Appendix (10) and (11): logistic noise, no outliers, D* uniform from −∞: the evidence is Σ (D_i − d_i)/s_i.
TEST(Evidence, NoSelfOcclusionWithLogisticNoiseIsTheCurlessLevoySum) {
  const Pinhole camera{64, 64, 80, 80, 31.5, 31.5, {}};
  std::vector<View> views;
  const Points eyes = {{0, 0, 2}, {0.3, 0.1, 1.9}, {-0.2, 0.4, 2.1}, {0.1, -0.5, 2.2}};
  for (const Eigen::Vector3d& eye : eyes)
    views.push_back(test::castView(eye, {0, 0, 0}, camera, test::planeCaster(0)));
  test::addNoise(views, {0.01, 0, 0}, 5);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const JudgedViews judged = believe(views, {logisticNoise(), {0.02, 0, 0}, -kInfinity, kInfinity}, 0.0);
  Points points;
  Random random(4);
  for (int i = 0; i < 300; ++i)
    points.emplace_back(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-1.5, 1.5));
  const std::vector<float> found = evidenceAt(judged, points, rule(EvidenceRule::NoSelfOcclusion));
  const std::vector<double> sums = untruncatedSum(judged, points);
  for (std::size_t i = 0; i < points.size(); ++i)
    ASSERT_NEAR(found[i], sums[i], 1e-5 * (1 + std::abs(sums[i]))) << i;
}

TEST(Evidence, ConstantBallooningIsTheSameEverywhere) {
  EvidenceOptions options = rule(EvidenceRule::Constant);
  options.balloon = 0.7;
  for (const float e : evidenceAt(sphere(2), randomPoints(10), options)) EXPECT_FLOAT_EQ(e, -0.7f);
}

TEST(Evidence, MoreFaithInVisibilityNeedsFewerDenials) {
  const Points centre = {{0, 0, 0}};
  EvidenceOptions options;
  options.visibility = 0.05;
  const float low = evidenceAt(sphere(), centre, options).front();
  options.visibility = 0.5;
  EXPECT_LT(evidenceAt(sphere(), centre, options).front(), low - 5);
}

TEST(Evidence, OfACellIsThatOfItsCentreOrTheMeanOfItsSamples) {
  const test::RandomOctree random = test::randomOctree(2, 40, 4);
  Octree octree = random.octree;
  octree.frame.voxel = 0.04;
  octree.frame.offset = -0.04 * (octree.origin + octree.size / 2).cast<double>();
  const JudgedViews judged = sphere(8);
  const std::vector<float> sigma = evidence(judged, octree, {});
  ASSERT_EQ(sigma.size(), octree.cellCount());
  std::size_t levels_seen[5] = {};
  for (std::size_t c = 0; c < octree.cellCount(); ++c) {
    const int n = octree.levels[c] == 0 ? 1 : octree.levels[c] <= 2 ? 2 : 4;
    Points samples;
    for (int i = 0; i < n * n * n; ++i) {
      const Eigen::Array3d share = (Eigen::Array3d(i % n, i / n % n, i / n / n) + 0.5) / n;
      samples.push_back(octree.frame.toWorld(
          Eigen::Vector3d(octree.lowest(c).cast<double>().array() - 0.5 + octree.side(c) * share)));
    }
    double sum = 0;
    for (const float e : evidenceAt(judged, samples, {})) sum += e;
    ASSERT_NEAR(sigma[c], sum / (n * n * n), 1e-4);
    ++levels_seen[octree.levels[c]];
    if (levels_seen[0] > 300 && octree.levels[c] == 0) break;
  }
  const ThreadLimit one(1);
  EXPECT_EQ(evidence(judged, octree, {}), sigma);
}

TEST(Evidence, FarBehindAMeasuredSurfaceNothingIsKnown) {
  EvidenceOptions options;
  options.thickness = 0.05;
  const JudgedViews judged = sphere(1);
  const Eigen::Vector3d eye = judged.views[0].world_from_camera.translation(), to = -eye.normalized();
  const auto behind = [&](double distance, const EvidenceOptions& o) {
    return evidenceAt(judged, {-0.5 * to + distance * to}, o).front();
  };
  EXPECT_LT(behind(0.03, options), -0.1);
  EXPECT_NEAR(behind(0.015, options), behind(0.015, {}), 0.1);
  EXPECT_NEAR(behind(0.3, options), 0, 1e-3);
  EXPECT_LT(behind(0.3, {}), -0.1);
  // In front of it nothing changes.
  EXPECT_EQ(behind(-0.3, options), behind(-0.3, {}));
}

TEST(Evidence, OptionsThatCannotBeAreAllReportedAndRefused) {
  EvidenceOptions options;
  EXPECT_TRUE(validate(options).empty());
  options.visibility_prior = 0, options.visibility = 1.1, options.prior = NAN, options.balloon = -1;
  options.max_no_returns = -1, options.mask_error = 0.5;
  EXPECT_EQ(validate(options).size(), 6u);
  EXPECT_THROW(evidenceAt(sphere(1), {}, options), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
