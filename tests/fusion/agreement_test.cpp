// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/agreement.h"

#include <gtest/gtest.h>

#include "fusion/scenes.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/projector.h"

namespace vdbfuse {
namespace {

const Box kDomain(Eigen::Vector3d(-0.6, -0.6, -0.6), Eigen::Vector3d(0.6, 0.6, 0.6));

JudgedViews sphere(double outlier = kMinOutlier) {
  return believe(test::sphereViews(20), test::sphereSensor(), outlier);
}

TEST(CountAgreement, CountsTheViewsThatSeeASurfaceEachAtMostOnce) {
  const ScalarGrid support = countAgreement(sphere(), {0.03}, kDomain);
  float largest = 0, smallest_on_surface = 100;
  for (std::size_t i = 0; i < support.leafCount(); ++i) {
    const ScalarGrid::Leaf leaf = support.leaf(i);
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const Index3 v = leaf.origin + Index3(k / 64, k / 8 % 8, k % 8);
      const double off = std::abs(support.frame().toWorld(v).norm() - 0.5);
      const float c = leaf.values[static_cast<std::size_t>(k)];
      largest = std::max(largest, c);
      if (off < 0.005) smallest_on_surface = std::min(smallest_on_surface, c);
      if (off > 0.2) {
        ASSERT_LT(c, kSupported);
      }
    }
  }
  // Every point of the sphere is seen by between a quarter and a half of all views.
  EXPECT_LT(largest, 10);
  EXPECT_GT(largest, 4);
  EXPECT_GT(smallest_on_surface, 2);
}

// Equation (3) as agreement.h has it, a voxel and a view at a time.
double countDirectly(const JudgedViews& judged, const Eigen::Vector3d& point, double voxel) {
  double count = 0;
  for (const JudgedView& view : judged.views) {
    const auto seen = Projector(view.projection, view.world_from_camera)(point);
    if (!seen || view.depth(seen->x, seen->y) == kInvalidDepth) continue;
    const double depth = view.depth(seen->x, seen->y);
    const double r =
        std::abs(depth - seen->depth) / std::max(voxel, lookupNoise(judged.sensor, view.projection, depth));
    if (r <= 2) count += view.weight * (1 - view.outlier(seen->x, seen->y)) * std::exp(-r * r);
  }
  return count;
}

TEST(CountAgreement, IsTheSumOfTheKernelsOfAllViews) {
  JudgedViews judged = sphere();
  Random random(8);
  for (JudgedView& view : judged.views) {
    view.weight = random.uniform(0.2, 1);
    for (float& e : view.outlier) e = static_cast<float>(random.uniform(0, 0.45));
  }
  JudgedViews with_alternatives = judged;  // another path: of which none is believed
  for (JudgedView& view : with_alternatives.views)
    view.alternatives.push_back({Image<float>(64, 64, 1.0f), Image<float>(64, 64, 0.0f)});
  for (const double voxel : {0.03, 0.004}) {  // above and below the noise
    const ScalarGrid support = countAgreement(judged, {voxel}, kDomain);
    const ScalarGrid other = countAgreement(with_alternatives, {voxel}, kDomain);
    ASSERT_EQ(other.leafCount(), support.leafCount());
    std::size_t compared = 0, off = 0;
    for (std::size_t i = 0; i < support.leafCount(); i += 1 + support.leafCount() / 40) {
      for (int k = 0; k < ScalarGrid::kLeafSize; k += 5) {
        const ScalarGrid::Leaf leaf = support.leaf(i);
        const float count = leaf.values[static_cast<std::size_t>(k)];
        const Eigen::Vector3d point =
            support.frame().toWorld(Index3(leaf.origin + Index3(k / 64, k / 8 % 8, k % 8)));
        // Points on the border between two pixels may be given to either.
        off += std::abs(count - countDirectly(judged, point, voxel)) > 0.002 ||
               std::abs(count - other.leaf(i).values[static_cast<std::size_t>(k)]) > 0.002;
        ++compared;
      }
    }
    EXPECT_GT(compared, 2000u);
    EXPECT_LE(off, compared / 200) << voxel;
  }
}

TEST(CountAgreement, DoubtAndWeightScaleTheCount) {
  const Index3 v(0, 0, 17);  // 0.01 off the surface
  const float full = countAgreement(sphere(0.0), {0.03}, kDomain).at(v);
  EXPECT_NEAR(countAgreement(sphere(0.4), {0.03}, kDomain).at(v), 0.6f * full, 1e-4f * full);
  JudgedViews weighted = sphere(0.0);
  for (JudgedView& view : weighted.views) view.weight = 0.25;
  EXPECT_NEAR(countAgreement(weighted, {0.03}, kDomain).at(v), 0.25f * full, 1e-4f * full);
  EXPECT_GT(full, 1);
}

TEST(CountAgreement, PixelsThatNobodyBelievesOrThatLieOutsideMakeNoLeaves) {
  EXPECT_EQ(countAgreement(sphere(0.6), {0.03}, kDomain).leafCount(), 0u);
  const Box empty_corner(Eigen::Vector3d(0.5, 0.5, 0.5), Eigen::Vector3d(0.6, 0.6, 0.6));
  EXPECT_EQ(countAgreement(sphere(), {0.03}, empty_corner).leafCount(), 0u);
}

TEST(CountAgreement, IsTheSameForOneAndTwoThreads) {
  const JudgedViews judged = sphere();
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    const ScalarGrid grid = countAgreement(judged, {0.03}, kDomain);
    std::vector<float> values;
    for (std::size_t i = 0; i < grid.leafCount(); ++i)
      values.insert(values.end(), grid.leaf(i).values.begin(), grid.leaf(i).values.end());
    return values;
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(DiscontinuityCost, IsTheExponentialOfTheCount) {
  ScalarGrid support("support", {0.1}, 0.0f, {{0, 0, 0}, {8, 8, 8}});
  support.leaf(1).at(1, 2, 3) = 1.5f;
  const ScalarGrid rho = discontinuityCost(support, 2.0);
  EXPECT_EQ(rho.name(), "rho");
  EXPECT_FLOAT_EQ(rho.at({9, 10, 11}), std::exp(-3.0f));
  EXPECT_EQ(rho.at({0, 0, 0}), 1.0f);
  EXPECT_EQ(rho.at({100, 0, 0}), 1.0f);
  EXPECT_EQ(discontinuityCost(support, 2.0, 0.25).at({9, 10, 11}), 0.25f);
  EXPECT_EQ(discontinuityCost(support, 2.0, 0.04).at({9, 10, 11}), rho.at({9, 10, 11}));
}

}  // namespace
}  // namespace vdbfuse
