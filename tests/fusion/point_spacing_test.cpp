// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/point_spacing.h"

#include <gtest/gtest.h>

#include "fusion/scenes.h"

namespace vdbfuse {
namespace {

using test::castView;
using test::planeCaster;

constexpr double kDistance = 2.0, kFocal = 200.0;
constexpr double kLattice = kDistance / kFocal;

View planeView(const Pinhole& camera, const Eigen::Vector3d& eye = {0, 0, kDistance}) {
  return castView(eye, Eigen::Vector3d::Zero(), camera, planeCaster(0));
}

double spacingOf(std::vector<View> views) { return pointSpacing(believe(std::move(views), {})); }

TEST(PointSpacing, IsThePixelOnAPlaneSeenStraightOn) {
  const Pinhole camera{160, 120, kFocal, kFocal, 80, 60, {}};
  EXPECT_NEAR(spacingOf({planeView(camera)}), kLattice, 0.01 * kLattice);
}

TEST(PointSpacing, GrowsWhereTheSurfaceIsSlanted) {
  const Pinhole camera{160, 120, kFocal, kFocal, 80, 60, {}};
  const Eigen::Vector3d eye = kDistance * Eigen::Vector3d(0.8, 0, 0.6);
  const double spacing = spacingOf({planeView(camera, eye)});
  EXPECT_GT(spacing, 1.15 * kLattice);
  EXPECT_LT(spacing, 1.7 * kLattice);
}

TEST(PointSpacing, KnowsTheSparseAxisOfTheSensor) {
  const Pinhole dense_along_x{160, 120, 3 * kFocal, kFocal, 80, 60, {}};
  const double spacing = spacingOf({planeView(dense_along_x)});
  EXPECT_NEAR(spacing, kLattice / std::sqrt(3.0), 0.3 * kLattice);
}

TEST(PointSpacing, IsTheMedianOverViewsOfDifferentSensors) {
  const Pinhole coarse{80, 60, kFocal, kFocal, 40, 30, {}}, fine{80, 60, 4 * kFocal, 4 * kFocal, 40, 30, {}};
  const double spacing = spacingOf({planeView(fine), planeView(coarse), planeView(fine)});
  EXPECT_NEAR(spacing, kLattice / 4, 0.01 * kLattice);
}

TEST(PointSpacing, DoesNotCountWhatIsProbablyWrong) {
  JudgedViews judged = believe({planeView({160, 120, kFocal, kFocal, 80, 60, {}})}, {});
  JudgedView& view = judged.views.front();
  Random random(1);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      if (random.uniform() > 0.3) continue;
      view.depth(x, y) = static_cast<float>(random.uniform(0.5, 4.0));
      view.outlier(x, y) = 0.9f;
    }
  }
  // Three in ten neighbours are gone; the wrong depths would make it ten times the lattice.
  EXPECT_GE(pointSpacing(judged), 0.99 * kLattice);
  EXPECT_LT(pointSpacing(judged), 1.5 * kLattice);
}

TEST(PointSpacing, IsZeroWithoutNeighbours) {
  View view = planeView({64, 48, kFocal, kFocal, 32, 24, {}});
  view.map.depth = Image<float>(64, 48, kInvalidDepth);
  view.map.depth(8, 6) = 1.0f;
  EXPECT_EQ(spacingOf({view}), 0.0);
  EXPECT_EQ(spacingOf({}), 0.0);
}

}  // namespace
}  // namespace vdbfuse
