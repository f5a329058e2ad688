// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/evaluation/evaluate.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "io/temporary_folder.h"
#include "mesh/shapes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using test::messageOf;

// Enough for two digits, and quick.
EvaluateOptions quick(std::vector<double> taus) {
  EvaluateOptions options;
  options.taus = std::move(taus);
  options.samples = 20000;
  options.iou_resolution = 64;
  options.region_samples = 4000;
  return options;
}

TEST(Evaluate, TheTruthItselfIsPerfect) {
  const TriangleMesh torus = test::torus();
  const Evaluation e = evaluate(torus, torus, quick({1e-6}));
  EXPECT_LT(e.accuracy90, 1e-6);
  EXPECT_LT(e.accuracy_rms, 1e-6);
  EXPECT_EQ(e.completeness, 1.0);
  EXPECT_EQ(e.scores[0].precision, 1.0);
  EXPECT_EQ(e.scores[0].fscore, 1.0);
  EXPECT_EQ(e.iou, 1.0);
  EXPECT_TRUE(isClosedManifold(e.topology));
}

TEST(Evaluate, ALargerConcentricSphereIsOffByTheDifferenceOfTheRadii) {
  const Evaluation e = evaluate(test::sphere(1.1, 5), test::sphere(1.0, 5), quick({0.05, 0.2}));
  EXPECT_NEAR(e.accuracy90, 0.1, 0.002);
  EXPECT_NEAR(e.accuracy_rms, 0.1, 0.002);
  EXPECT_EQ(e.scores[0].fscore, 0.0);
  EXPECT_EQ(e.scores[1].fscore, 1.0);
  EXPECT_EQ(e.completeness, 0.0);
  EXPECT_NEAR(*e.iou, std::pow(1 / 1.1, 3), 0.002);
}

TEST(Evaluate, TheIouOfShiftedBoxesIsExactToAThousandth) {
  EvaluateOptions options = quick({0.1});
  options.iou_resolution = 128;
  const Evaluation e =
      evaluate(test::box({0.3f, 0.1f, 0}, {1.3f, 1.1f, 1}), test::box({0, 0, 0}, {1, 1, 1}), options);
  const double both = 0.7 * 0.9;
  EXPECT_NEAR(*e.iou, both / (2 - both), 0.001);
}

TEST(Evaluate, ATriangleFarAwayDoesNotSpoilTheIou) {
  TriangleMesh mesh = test::sphere(1.0, 4);
  mesh = test::joined(mesh, test::sphere(0.01, 1, {1000, 0, 0}));
  EXPECT_NEAR(*evaluate(mesh, test::sphere(1.0, 4), quick({0.1})).iou, 1.0, 1e-3);
}

TEST(Evaluate, HalfASphereIsPreciseAndHalfComplete) {
  const TriangleMesh truth = test::sphere(1.0, 5);
  const Evaluation e = evaluate(test::upperHalf(truth), truth, quick({0.001}));
  EXPECT_EQ(e.scores[0].precision, 1.0);
  EXPECT_NEAR(e.scores[0].recall, 0.5, 0.01);
  EXPECT_NEAR(e.scores[0].fscore, 2.0 / 3, 0.01);
  EXPECT_NEAR(e.completeness, 0.5, 0.01);
  EXPECT_GT(e.topology.open_edges, 0u);
}

TEST(Evaluate, NinetyPercentAreWithinTheAccuracyAndTheRestMayBeWild) {
  // 5 % of the area lie far away.
  const TriangleMesh truth = test::sphere(1.0, 5);
  const double radius = std::sqrt(0.05 / 0.95);
  const TriangleMesh mesh = test::joined(truth, test::sphere(radius, 5, {10, 0, 0}));
  const Evaluation e = evaluate(mesh, truth, quick({0.01}));
  EXPECT_LT(e.accuracy90, 1e-6);
  EXPECT_GT(e.accuracy_rms, 1.0);
  EXPECT_NEAR(e.scores[0].precision, 0.95, 0.001);
  EXPECT_EQ(e.topology.components, 2u);
}

TEST(Evaluate, AnEmptyMeshHasNothingRight) {
  const Evaluation e = evaluate({}, test::sphere(1.0, 3), quick({0.01}));
  EXPECT_EQ(e.accuracy90, std::numeric_limits<double>::infinity());
  EXPECT_EQ(e.completeness, 0.0);
  EXPECT_EQ(e.scores[0].fscore, 0.0);
  EXPECT_EQ(e.iou, 0.0);
}

TEST(Evaluate, AMeshThatIsInsideOutEnclosesNothing) {
  const TriangleMesh sphere = test::sphere(1.0, 3);
  EXPECT_EQ(evaluate(test::inverted(sphere), sphere, quick({0.1})).iou, 0.0);
  EXPECT_EQ(evaluate(test::inverted(sphere), test::inverted(sphere), quick({0.1})).iou, std::nullopt);
}

TEST(Evaluate, TheDefaultTauIsAHundredthOfTheTruthsDiagonal) {
  const Evaluation e = evaluate(test::octahedron(), test::box({0, 0, 0}, {3, 4, 12}), quick({}));
  ASSERT_EQ(e.scores.size(), 1u);
  EXPECT_DOUBLE_EQ(e.scores[0].tau, 0.13);
}

TEST(Evaluate, RegionsAreSharesOfWhereTheTruthIsAsExpected) {
  // The truth is hollow; the mesh has filled the right half of the cavity.
  const TriangleMesh shell = test::box({-2, -2, -2}, {2, 2, 2});
  const TriangleMesh truth = test::joined(shell, test::inverted(test::box({-1, -1, -1}, {1, 1, 1})));
  const TriangleMesh mesh = test::joined(shell, test::inverted(test::box({-1, -1, -1}, {0, 1, 1})));
  const Eigen::Vector3d ones = Eigen::Vector3d::Ones();
  const std::vector<Region> regions = {
      {"cavity", Expectation::Outside, Box(-ones, ones)},
      {"cavity and its wall", Expectation::Outside, Box(-1.5 * ones, 1.5 * ones)},
      {"body", Expectation::Inside, Box(1.1 * ones, 1.9 * ones)},
      {"nonsense", Expectation::Inside, RegionSphere{{9, 9, 9}, 1}}};
  const Evaluation e = evaluate(mesh, truth, quick({0.1}), regions);
  EXPECT_EQ(e.regions[0].name, "cavity");
  EXPECT_NEAR(*e.regions[0].share, 0.5, 0.03);
  EXPECT_NEAR(*e.regions[1].share, 0.5, 0.05);
  EXPECT_EQ(e.regions[2].share, 1.0);
  EXPECT_EQ(e.regions[3].share, std::nullopt);
}

EvaluateOptions deeperThan(double deep) {
  EvaluateOptions options = quick({0.1});
  options.samples = 1000;
  options.deep = deep;
  return options;
}

TEST(Evaluate, DeepVolumesCountWhatIsFurtherFromTheTrueSurface) {
  const TriangleMesh truth = test::sphere(1.0, 5);
  const Evaluation small = evaluate(test::sphere(0.7, 5), truth, deeperThan(0.1));
  EXPECT_NEAR(*small.false_outside_deep, std::pow(0.9, 3) - std::pow(0.7, 3), 0.004);
  EXPECT_EQ(small.false_inside_deep, 0.0);
  const Evaluation large = evaluate(test::sphere(1.5, 5), truth, deeperThan(0.1));
  EXPECT_NEAR(*large.false_inside_deep, std::pow(1.5, 3) - std::pow(1.1, 3), 0.03);
  EXPECT_EQ(large.false_outside_deep, 0.0);
  const Evaluation near = evaluate(test::sphere(0.95, 5), truth, deeperThan(0.1));
  EXPECT_EQ(near.false_outside_deep, 0.0);
}

TEST(Evaluate, OfABiteOutOfASphereOnlyThePartDeepEnoughCounts) {
  const TriangleMesh truth = test::sphere(1.0, 5);
  const double distance = 0.4, radius = 0.3, deep = 0.6, core = 1 - deep;
  const TriangleMesh bubble = test::inverted(test::sphere(radius, 4, {distance, 0, 0}));
  const TriangleMesh bitten = test::joined(truth, bubble);
  const double whole = std::pow(radius, 3);
  EXPECT_NEAR(*evaluate(bitten, truth, deeperThan(0.2)).false_outside_deep, whole, 0.001);
  // Of two balls, what they share (the lens), as a share of the unit ball.
  const double d = distance, sum = radius + core, difference = radius - core;
  const double lens = std::pow(sum - d, 2) * (d * d + 2 * d * sum - 3 * difference * difference) / (16 * d);
  EXPECT_LT(lens, 0.5 * whole);
  EXPECT_NEAR(*evaluate(bitten, truth, deeperThan(deep)).false_outside_deep, lens, 0.001);
}

TEST(Evaluate, AThingInventedFarAwayIsDeepWholly) {
  const TriangleMesh truth = test::sphere(1.0, 4);
  const TriangleMesh mesh = test::joined(truth, test::sphere(0.5, 4, {4, 0, 0}));
  EXPECT_NEAR(*evaluate(mesh, truth, deeperThan(0.2)).false_inside_deep, 0.125, 0.004);
}

TEST(Evaluate, DeepVolumesAreGivenOnlyWhenAskedForAndDoNotChangeTheIou) {
  const TriangleMesh truth = test::sphere(1.0, 4), mesh = test::sphere(1.2, 4, {0.3, 0, 0});
  EvaluateOptions options = deeperThan(0.05);
  const Evaluation with = evaluate(mesh, truth, options);
  options.deep.reset();
  const Evaluation without = evaluate(mesh, truth, options);
  EXPECT_TRUE(with.false_outside_deep && with.false_inside_deep);
  EXPECT_FALSE(without.false_outside_deep || without.false_inside_deep);
  EXPECT_EQ(with.iou, without.iou);
}

TEST(Evaluate, OneThreadFindsTheSameToTheLastBit) {
  const TriangleMesh mesh = test::torus(1.0, 0.31), truth = test::torus();
  const std::vector<Region> regions = {{"half", Expectation::Inside, RegionSphere{{1, 0, 0}, 0.3}}};
  EvaluateOptions options = quick({0.01});
  options.deep = 0.001;
  const Evaluation many = evaluate(mesh, truth, options, regions);
  const ThreadLimit limit(1);
  const Evaluation one = evaluate(mesh, truth, options, regions);
  EXPECT_EQ(one.accuracy90, many.accuracy90);
  EXPECT_EQ(one.accuracy_rms, many.accuracy_rms);
  EXPECT_EQ(one.scores[0].fscore, many.scores[0].fscore);
  EXPECT_EQ(one.iou, many.iou);
  EXPECT_EQ(one.false_inside_deep, many.false_inside_deep);
  EXPECT_EQ(one.regions[0].share, many.regions[0].share);
}

TEST(Evaluate, AllThatIsWrongWithTheOptionsIsSaidAtOnce) {
  EvaluateOptions options;
  options.taus = {0.1, -1};
  options.samples = 0;
  options.region_samples = 0;
  options.iou_resolution = 0;
  options.deep = -0.5;
  EXPECT_EQ(validate(options).size(), 5u);
  EXPECT_EQ(
      messageOf<InvalidArgument>([&] { evaluate({}, test::octahedron(), options); }),
      "options: taus must be positive, found -1.000000; deep must not be negative, found -0.500000; samples "
      "must be positive; region_samples must be positive; iou_resolution must be in 1 … 2048, found 0");
}

TEST(Evaluate, ATruthWithoutAreaIsRefused) {
  EXPECT_EQ(messageOf<InvalidArgument>([] { evaluate(test::octahedron(), {}); }),
            "truth: has no triangle with an area");
}

}  // namespace
}  // namespace vdbfuse
