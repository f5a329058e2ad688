// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/domain.h"

#include <gtest/gtest.h>

#include "fusion/scenes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

JudgedViews sphere(int views = 12) { return believe(test::sphereViews(views), test::sphereSensor()); }

bool isSame(const Box& a, const Box& b, double tolerance = 0) {
  return (a.min() - b.min()).norm() <= tolerance && (a.max() - b.max()).norm() <= tolerance;
}

TEST(SupportedDomain, IsTheSphereWithAMargin) {
  const Box box = supportedDomain(sphere());
  const double margin = 0.03 * std::sqrt(3.0);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box.min()[axis], -0.5 - margin, 0.03);
    EXPECT_NEAR(box.max()[axis], 0.5 + margin, 0.03);
  }
}

TEST(SupportedDomain, OneWildDepthThatIsBelievedDoesNotChangeIt) {
  const Box box = supportedDomain(sphere());
  for (const float wild : {0.1f, 100.0f, 1e6f}) {
    JudgedViews judged = sphere();
    judged.views[3].depth(0, 0) = wild;
    EXPECT_TRUE(isSame(supportedDomain(judged), box, 2e-3)) << wild;
  }
}

TEST(SupportedDomain, AnyNumberOfPixelsThatNobodyBelievesDoesNotChangeIt) {
  const Box box = supportedDomain(sphere());
  JudgedViews judged = sphere();
  for (JudgedView& view : judged.views)
    for (std::size_t i = 0; i < view.depth.size(); ++i)
      if (view.depth.data()[i] == kInvalidDepth) view.depth.data()[i] = 5.0f, view.outlier.data()[i] = 0.9f;
  EXPECT_TRUE(isSame(supportedDomain(judged), box));
}

TEST(SupportedDomain, ASingleViewIsSupportedByItself) {
  const Box box = supportedDomain(sphere(1));
  EXPECT_GT(box.volume(), 0);
}

TEST(SupportedDomain, NothingBelievedAndNoOverlapAreTwoDifferentErrors) {
  const auto messageOf = [](const JudgedViews& judged) -> std::string {
    try {
      supportedDomain(judged);
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "";
  };
  JudgedViews doubted = sphere();
  for (JudgedView& view : doubted.views) std::fill(view.outlier.begin(), view.outlier.end(), 0.9f);
  EXPECT_EQ(messageOf(doubted), "views: no depth is believed by any other view; nothing to reconstruct");
  JudgedViews apart = sphere(2);
  apart.views[1].world_from_camera.translation().x() += 10;
  EXPECT_EQ(messageOf(apart), "views: the views do not overlap: no place is seen by two of them");
}

TEST(WidenRange, HoldsTheWholeDomainInFrontOfEverySensor) {
  JudgedViews judged = sphere();
  judged.sensor.near = 1.6, judged.sensor.far = 2.0;
  const Box domain(Eigen::Vector3d(-0.7, -0.7, -0.7), Eigen::Vector3d(0.7, 0.7, 0.7));
  widenRange(judged, domain);
  for (const JudgedView& view : judged.views) {
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector3d p = domain.corner(static_cast<Box::CornerType>(corner));
      const double depth = (view.world_from_camera.inverse() * p).z();
      EXPECT_LT(judged.sensor.near, depth);
      EXPECT_GT(judged.sensor.far, depth);
    }
  }
  EXPECT_GT(judged.sensor.near, 0.7);
  EXPECT_LT(judged.sensor.far, 3.4);
  const SensorModel wide = judged.sensor;
  widenRange(judged, Box(Eigen::Vector3d(-0.1, -0.1, -0.1), Eigen::Vector3d(0.1, 0.1, 0.1)));
  EXPECT_EQ(judged.sensor.near, wide.near);
  EXPECT_EQ(judged.sensor.far, wide.far);
}

}  // namespace
}  // namespace vdbfuse
