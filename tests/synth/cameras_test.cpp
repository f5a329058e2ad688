// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mesh/shapes.h"
#include "synth/cameras.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> eyes(Arc arc, int count) {
  SynthOptions options;
  options.arc = arc, options.views = count;
  std::vector<Vector3d> result;
  for (const ViewHeader& h : synth::placeCameras(Scene{}, options))
    result.push_back(h.world_from_camera.translation());
  return result;
}

class LookingArc : public testing::TestWithParam<Arc> {};

TEST_P(LookingArc, EveryCameraLooksAtTheCentreFromTheStatedDistance) {
  SynthOptions options;
  options.arc = GetParam(), options.views = 37;
  for (const ViewHeader& h : synth::placeCameras(Scene{}, options)) {
    const Vector3d center = h.world_from_camera.inverse() * Vector3d::Zero();
    EXPECT_LT((center - Vector3d(0, 0, kCameraDistance)).norm(), 1e-12);
    const auto pixel = project(h.projection, center);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x, 0.5 * (options.width - 1), 1e-9);
    EXPECT_NEAR(pixel->y, 0.5 * (options.height - 1), 1e-9);
    EXPECT_NEAR(h.world_from_camera.linear().determinant(), 1, 1e-12);
  }
}

TEST_P(LookingArc, NoCameraHangsUpsideDown) {
  SynthOptions options;
  options.arc = GetParam(), options.views = 37;
  for (const ViewHeader& h : synth::placeCameras(Scene{}, options))
    EXPECT_LE(h.world_from_camera.linear().col(1).z(), 1e-12);
}

TEST_P(LookingArc, TheWholeBoundingSphereIsInThePicture) {
  SynthOptions options;
  options.arc = GetParam(), options.views = 5;
  for (const ViewHeader& h : synth::placeCameras(Scene{}, options)) {
    for (const Eigen::Vector3f& v : test::sphere(0.5, 2).vertices) {
      const auto pixel = project(h.projection, h.world_from_camera.inverse() * v.cast<double>());
      ASSERT_TRUE(pixel);
      EXPECT_GE(std::min(pixel->x, pixel->y), 0);
      EXPECT_LE(pixel->y, options.height - 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Synth, LookingArc, testing::Values(Arc::Full, Arc::Ring, Arc::Upper, Arc::Front));

TEST(Cameras, TheRingLiesTenDegreesAboveTheHorizonAndBeginsAtTheFront) {
  const std::vector<Vector3d> ring = eyes(Arc::Ring, 36);
  EXPECT_LT(ring.front().y(), 0);
  EXPECT_NEAR(ring.front().x(), 0, 1e-12);
  for (const Vector3d& eye : ring)
    EXPECT_NEAR(eye.z() / kCameraDistance, std::sin(10 * std::numbers::pi / 180), 1e-12);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector3d flat(ring[i].x(), ring[i].y(), 0), next(ring[(i + 1) % 36].x(), ring[(i + 1) % 36].y(), 0);
    EXPECT_NEAR(flat.normalized().dot(next.normalized()), std::cos(10 * std::numbers::pi / 180), 1e-12);
  }
}

TEST(Cameras, TheUpperArcStaysAboveTheHorizonAndTheFrontOneInItsCap) {
  for (const Vector3d& eye : eyes(Arc::Upper, 24)) EXPECT_GT(eye.z(), 0);
  for (const Vector3d& eye : eyes(Arc::Front, 16))
    EXPECT_GT(-eye.y() / kCameraDistance, std::cos(50 * std::numbers::pi / 180));
}

TEST(Cameras, TheFullArcIsEven) {
  const std::vector<Vector3d> all = eyes(Arc::Full, 72);
  Vector3d sum = Vector3d::Zero();
  double nearest = 1e9;
  for (std::size_t i = 0; i < all.size(); ++i) {
    sum += all[i] / kCameraDistance;
    for (std::size_t k = 0; k < i; ++k) nearest = std::min(nearest, (all[i] - all[k]).norm());
  }
  EXPECT_LT(sum.norm(), 1);
  EXPECT_GT(nearest / kCameraDistance, 0.25);
}

TEST(Cameras, OfARoomAreInsideItAndOutsideTheObject) {
  for (const Vector3d& eye : eyes(Arc::Room, 24)) {
    EXPECT_GT(eye.norm(), 1);
    EXPECT_TRUE((eye.cwiseAbs().array() < kRoomHalfSize.array() - 0.2).all());
  }
}

}  // namespace
}  // namespace vdbfuse
