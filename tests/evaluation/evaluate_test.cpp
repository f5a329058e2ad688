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

TEST(Evaluate, OneThreadFindsTheSameToTheLastBit) {
  const TriangleMesh mesh = test::torus(1.0, 0.31), truth = test::torus();
  const std::vector<Region> regions = {{"half", Expectation::Inside, RegionSphere{{1, 0, 0}, 0.3}}};
  const Evaluation many = evaluate(mesh, truth, quick({0.01}), regions);
  const ThreadLimit limit(1);
  const Evaluation one = evaluate(mesh, truth, quick({0.01}), regions);
  EXPECT_EQ(one.accuracy90, many.accuracy90);
  EXPECT_EQ(one.accuracy_rms, many.accuracy_rms);
  EXPECT_EQ(one.scores[0].fscore, many.scores[0].fscore);
  EXPECT_EQ(one.iou, many.iou);
  EXPECT_EQ(one.regions[0].share, many.regions[0].share);
}

TEST(Evaluate, AllThatIsWrongWithTheOptionsIsSaidAtOnce) {
  EvaluateOptions options;
  options.taus = {0.1, -1};
  options.samples = 0;
  options.region_samples = 0;
  options.iou_resolution = 0;
  EXPECT_EQ(validate(options).size(), 4u);
  EXPECT_EQ(
      messageOf<InvalidArgument>([&] { evaluate({}, test::octahedron(), options); }),
      "options: taus must be positive, found -1.000000; samples must be positive; region_samples must be "
      "positive; iou_resolution must be in 1 … 2048, found 0");
}

TEST(Evaluate, ATruthWithoutAreaIsRefused) {
  EXPECT_EQ(messageOf<InvalidArgument>([] { evaluate(test::octahedron(), {}); }),
            "truth: has no triangle with an area");
}

}  // namespace
}  // namespace vdbfuse
