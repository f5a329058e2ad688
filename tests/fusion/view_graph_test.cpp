// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/view_graph.h"

#include <gtest/gtest.h>

#include <numeric>

#include "fusion/scenes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Cameras that circle the origin at distance 2, one each `step_deg`.
std::vector<ViewHeader> ring(int count, double step_deg, int repeats = 1) {
  std::vector<ViewHeader> views;
  for (int i = 0; i < count; ++i) {
    const double angle = i * step_deg * kDegree;
    ViewHeader view;
    view.world_from_camera =
        lookAt({2 * std::cos(angle), 2 * std::sin(angle), 0}, {0, 0, 0}, Eigen::Vector3d::UnitZ());
    for (int k = 0; k < repeats; ++k) views.push_back(view);
  }
  return views;
}

ViewGraph graphOf(const std::vector<ViewHeader>& views) {
  std::vector<const ViewHeader*> headers;
  for (const ViewHeader& view : views) headers.push_back(&view);
  return {headers, 2.0};
}

double sumOf(const std::vector<double>& weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

TEST(PathThrough, VisitsEveryViewOnceFromNeighbourToNeighbour) {
  std::vector<ViewHeader> views = ring(36, 10);
  std::vector<std::size_t> shuffled;
  for (std::size_t i = 0; i < 36; ++i) shuffled.push_back(i * 7 % 36);
  std::vector<ViewHeader> mixed;
  for (const std::size_t i : shuffled) mixed.push_back(views[i]);
  const std::vector<std::size_t> path = pathThrough(graphOf(mixed), mixed.size());
  ASSERT_EQ(path.size(), 36u);
  std::vector<bool> visited(36, false);
  int far = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    EXPECT_FALSE(visited[path[k]]);
    visited[path[k]] = true;
    if (k == 0) continue;
    const auto steps = (36 + shuffled[path[k]] - shuffled[path[k - 1]]) % 36;
    far += steps != 1 && steps != 35;
  }
  EXPECT_LE(far, 1);
}

TEST(ViewGraph, TheAngleOfCamerasThatCircleAnObjectIsTheAngleBetweenThem) {
  const ViewGraph graph = graphOf(ring(36, 10));
  EXPECT_NEAR(graph.angle(0, 1), 10 * kDegree, 0.002);
  EXPECT_NEAR(graph.angle(0, 35), 10 * kDegree, 0.002);
  EXPECT_NEAR(graph.angle(3, 6), 30 * kDegree, 0.01);  // a chord: a little shorter than the arc
}

TEST(ViewGraph, TheOrderIsByAngleAndLeavesTheViewItselfOut) {
  const ViewGraph graph = graphOf(ring(24, 15));
  for (std::size_t i = 0; i < 24; ++i) {
    const auto& order = graph.byAngle(i);
    ASSERT_EQ(order.size(), 23u);
    for (std::size_t k = 0; k < order.size(); ++k) {
      EXPECT_NE(order[k], i);
      if (k > 0) {
        EXPECT_LE(graph.angle(i, order[k - 1]), graph.angle(i, order[k]) + 1e-6);
      }
    }
  }
  EXPECT_THROW(ViewGraph({}, 0.0), InvalidArgument);
}

TEST(ChooseNeighbours, OnARingTheyAreTheNearestThatAreFarEnoughFromEachOther) {
  const auto chosen = chooseNeighbours(graphOf(ring(120, 3)), 120);
  for (std::size_t i = 0; i < 120; ++i) {
    ASSERT_EQ(chosen[i].size(), 10u);
    for (const std::size_t a : chosen[i]) {
      const auto steps = [](std::size_t p, std::size_t q) {
        return std::min((p + 120 - q) % 120, (q + 120 - p) % 120);
      };
      EXPECT_GE(steps(a, i), 2u);   // 3° is too near
      EXPECT_LE(steps(a, i), 10u);  // every other one, five to each side
      for (const std::size_t b : chosen[i]) EXPECT_TRUE(a == b || steps(a, b) >= 2u);
    }
  }
}

TEST(ChooseNeighbours, InAVideoTheAngleIsHalvedUntilThereAreEnough) {
  const auto chosen = chooseNeighbours(graphOf(ring(30, 0.2)), 30);  // 6° altogether
  for (const auto& neighbours : chosen) EXPECT_GE(neighbours.size(), 4u);
}

TEST(ChooseNeighbours, RepeatedFramesAreUsedWhenThereIsNothingElse) {
  const auto chosen = chooseNeighbours(graphOf(ring(1, 0, 30)), 30);
  for (const auto& neighbours : chosen) EXPECT_GE(neighbours.size(), 4u);
  EXPECT_TRUE(chooseNeighbours(graphOf(ring(1, 0)), 1).front().empty());
  EXPECT_EQ(chooseNeighbours(graphOf(ring(2, 90)), 2).front(), std::vector<std::size_t>{1});
}

TEST(RedundancyWeights, ViewsThatAreFarApartCountFully) {
  for (const double w : redundancyWeights(graphOf(ring(12, 30)), 12)) EXPECT_NEAR(w, 1, 1e-6);
}

TEST(RedundancyWeights, RepeatedViewsShareOneWeight) {
  for (const int repeats : {3, 20}) {
    const std::vector<ViewHeader> views = ring(12, 30, repeats);
    const std::vector<double> weights = redundancyWeights(graphOf(views), views.size());
    for (const double w : weights) EXPECT_NEAR(w, 1.0 / repeats, 1e-6);
    EXPECT_NEAR(sumOf(weights), 12, 1e-4);
  }
}

TEST(RedundancyWeights, AVideoKeepsTheWorthOfTwelveViews) {
  const std::vector<ViewHeader> views = ring(50, 0.5);
  const double sum = sumOf(redundancyWeights(graphOf(views), views.size()));
  EXPECT_GE(sum, 12);
  EXPECT_LT(sum, 40);
}

}  // namespace
}  // namespace vdbfuse
