// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/organised_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

View slantedPlane() {
  View view;
  view.projection = Pinhole{12, 9, 20, 21, 5.3, 4.1, {}};
  view.map.depth = Image<float>(12, 9);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 12; ++x) view.map.depth(x, y) = 2.0f + 0.1f * static_cast<float>(x);
  }
  view.map.depth(3, 4) = kInvalidDepth;
  return view;
}

TEST(OrganisedPoints, ThereAndBackKeepsEveryDepth) {
  const View view = slantedPlane();
  const View back = viewFromPoints(pointsOf(view), view.projection, view.world_from_camera);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 12; ++x) EXPECT_NEAR(back.map.depth(x, y), view.map.depth(x, y), 1e-6);
  }
}

TEST(OrganisedPoints, CameraIsFoundFromItsPoints) {
  const Pinhole truth = std::get<Pinhole>(slantedPlane().projection);
  const Pinhole found = fitPinhole(pointsOf(slantedPlane()));
  EXPECT_EQ(found.width, truth.width);
  EXPECT_NEAR(found.fx, truth.fx, 1e-4);
  EXPECT_NEAR(found.fy, truth.fy, 1e-4);
  EXPECT_NEAR(found.cx, truth.cx, 1e-4);
  EXPECT_NEAR(found.cy, truth.cy, 1e-4);
}

TEST(OrganisedPoints, PointsOfAParallelProjectionFitNoPinhole) {
  View view = slantedPlane();
  view.projection = Orthographic{12, 9, 0, 0.1, 0, 0.1};
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 12; ++x) view.map.depth(x, y) = (x + y) % 2 == 0 ? 1.0f : 3.0f;
  }
  EXPECT_THROW(fitPinhole(pointsOf(view)), InvalidArgument);
}

TEST(OrganisedPoints, PointsSeenInAMirrorFitNoCamera) {
  PointImage points = pointsOf(slantedPlane());
  for (Eigen::Vector3f& p : points) p.x() = -p.x();
  EXPECT_THROW(fitPinhole(points), InvalidArgument);
}

TEST(OrganisedPoints, TooFewPointsFitNothing) {
  PointImage points(4, 4, Eigen::Vector3f(0, 0, -1));
  try {
    fitPinhole(points);
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "points: expected at least 16 points in front of the camera, found 0");
  }
}

TEST(OrganisedPoints, OfAnotherSizeThanTheProjectionAreRefused) {
  EXPECT_THROW(viewFromPoints(noPoints(3, 3), slantedPlane().projection, RigidTransform::Identity()),
               InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
