// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

View room(const Spherical& scanner) {
  View view;
  view.projection = scanner;
  view.map.depth = Image<float>(scanner.width, scanner.height);
  for (int y = 0; y < scanner.height; ++y) {
    for (int x = 0; x < scanner.width; ++x)
      view.map.depth(x, y) = 2.0F + 0.05F * static_cast<float>((x + 3 * y) % 7);
  }
  return view;
}

void expectFound(const Spherical& truth) {
  const Spherical found = fitSpherical(pointsOf(room(truth)));
  EXPECT_EQ(found.width, truth.width);
  EXPECT_EQ(found.height, truth.height);
  EXPECT_NEAR(std::remainder(found.azimuth0 - truth.azimuth0, kTurn), 0, 1e-5);
  EXPECT_NEAR(found.azimuth_step, truth.azimuth_step, 1e-6);
  EXPECT_NEAR(found.elevation0, truth.elevation0, 1e-5);
  EXPECT_NEAR(found.elevation_step, truth.elevation_step, 1e-6);
}

TEST(FitSpherical, FullTurnCloses) { expectFound({40, 16, -3.0, kTurn / 40, -0.2, 0.05}); }

TEST(FitSpherical, TurnMayBeginAnywhere) { expectFound({40, 16, 2.5, kTurn / 40, -0.2, 0.05}); }

TEST(FitSpherical, ScannersMayTurnLeftAndUp) { expectFound({40, 16, 1.0, -kTurn / 60, 0.6, -0.05}); }

TEST(FitSpherical, PartOfATurnIsFound) { expectFound({30, 10, 3.0, 0.01, 0, 0.01}); }

TEST(FitSpherical, EmptyColumnsAreNoHindrance) {
  View view = room({40, 16, -3.0, kTurn / 40, -0.2, 0.05});
  for (int y = 0; y < 16; ++y) {
    for (int x = 10; x < 22; ++x) view.map.depth(x, y) = kInvalidDepth;
  }
  EXPECT_NEAR(fitSpherical(pointsOf(view)).azimuth_step, kTurn / 40, 1e-6);
}

TEST(FitSpherical, DepthsComeBack) {
  const View view = room({40, 16, -3.0, kTurn / 40, -0.2, 0.05});
  const PointImage points = pointsOf(view);
  const View back = viewFromPoints(points, fitSpherical(points), RigidTransform::Identity());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(back.map.depth.data()[i], view.map.depth.data()[i], 1e-6);
}

TEST(FitSpherical, PointsOfAPinholeFitNothing) {
  View view = room({40, 16, 0, 1, 0, 1});
  view.projection = Pinhole{40, 16, 12, 12, 20, 8, {}};
  EXPECT_THROW(fitSpherical(pointsOf(view)), InvalidArgument);
}

TEST(FitSpherical, TooFewPointsFitNothing) {
  try {
    fitSpherical(noPoints(8, 8));
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "points: expected at least 16 points, found 0");
  }
}

}  // namespace
}  // namespace vdbfuse
