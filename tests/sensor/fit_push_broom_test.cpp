// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {
namespace {

const Eigen::Vector3d kOrigin(0, 0.3, -1.7);

// A bumpy surface about 2 away, in a frame whose origin is not the sensor's.
PointImage bumps(const Projection& projection) {
  PointImage points = noPoints(imageWidth(projection), imageHeight(projection));
  for (int y = 0; y < points.height(); ++y) {
    for (int x = 0; x < points.width(); ++x) {
      const double depth = 2 + 0.1 * std::sin(0.7 * x) * std::cos(0.4 * y) + 0.01 * x;
      points(x, y) = (kOrigin + unproject(projection, x, y, depth)).cast<float>();
    }
  }
  return points;
}

TEST(FitPushBroom, SensorAndItsOriginAreFoundFromPoints) {
  for (const double sign : {1.0, -1.0}) {
    const PushBroom truth{20, 15, -0.4, 0.03 * sign, 0.5, 40 * sign, 9};
    const FittedPushBroom found = fitPushBroom(bumps(truth));
    EXPECT_EQ(found.sensor.width, 20);
    EXPECT_NEAR(found.sensor.x0, truth.x0, 1e-3);
    EXPECT_NEAR(found.sensor.x_step, truth.x_step, 1e-6);
    EXPECT_NEAR(found.sensor.x_shear, truth.x_shear, 1e-4);
    EXPECT_NEAR(found.sensor.fy, truth.fy, 0.02);
    EXPECT_NEAR(found.sensor.cy, truth.cy, 0.02);
    EXPECT_NEAR((found.origin - kOrigin).norm(), 0, 1e-3);
    EXPECT_LT(found.error_px, 1e-3);
  }
}

TEST(FitPushBroom, RowsThatDoNotConvergeFitNothing) {
  const PointImage points = bumps(Orthographic{20, 15, -0.4, 0.03, -0.2, 0.03});
  EXPECT_THROW(fitPushBroom(points), InvalidArgument);
}

TEST(FitPushBroom, RowsThatConvergeInFrontFitNothing) {
  PointImage points = bumps(PushBroom{20, 15, -0.4, 0.03, 0, 40, 9});
  for (Eigen::Vector3f& p : points) p.z() = -p.z();
  EXPECT_THROW(fitPushBroom(points), InvalidArgument);
}

TEST(FitPushBroom, PointsOfAPinholeFitNothing) {
  // A pinhole's columns converge too.
  EXPECT_THROW(fitPushBroom(bumps(Pinhole{80, 60, 60, 60, 40, 30, {}})), InvalidArgument);
}

TEST(FitPushBroom, TooFewPointsFitNothing) {
  try {
    fitPushBroom(noPoints(8, 8));
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "points: expected at least 16 points, found 0");
  }
  // All in one place.
  EXPECT_THROW(fitPushBroom(PointImage(8, 8, Eigen::Vector3f(1, 2, 3))), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
