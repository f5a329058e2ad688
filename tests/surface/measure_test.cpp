// SPDX-License-Identifier: Apache-2.0
#include "surface/measure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vdbfuse/geometry/look_at.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

constexpr double kVoxel = 0.01;
constexpr float kFocal = 300;

// A plane through the origin, seen exactly by a pinhole from `eye`.
struct PlaneView {
  Vector3d normal;
  JudgedViews judged;

  PlaneView(const Vector3d& plane_normal, const Vector3d& eye) : normal(plane_normal.normalized()) {
    View view;
    view.projection =
        Pinhole{.width = 200, .height = 200, .fx = kFocal, .fy = kFocal, .cx = 99.5, .cy = 99.5};
    view.world_from_camera = lookAt(eye, Vector3d::Zero(), Vector3d(0.1, 0.9, 0.3).normalized());
    view.map.depth = Image<float>(200, 200, kInvalidDepth);
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const Vector3d ray = view.world_from_camera.linear() * unproject(view.projection, x, y, 1.0);
        const double depth = -normal.dot(eye) / normal.dot(ray);
        if (depth > 0) view.map.depth(x, y) = static_cast<float>(depth);
      }
    judged = believe({view}, {gaussianNoise(), {0.001, 0, 0}, 0.2, 5});
    judged.views[0].incidence = Image<float>(200, 200, 0.7f);
  }
};

// Distances from the plane moved by `offset` along its normal, of `slope` times their size.
BlockField planeField(const Vector3d& normal, double offset, double slope = 1) {
  std::vector<Index3> origins;
  appendBlocks(Index3::Constant(-8), Index3::Constant(7), origins);
  BlockField field{{kVoxel}, BlockSet(origins), {}};
  for (std::size_t b = 0; b < field.blocks.count(); ++b)
    for (int i = 0; i < static_cast<int>(kBlockSize); ++i)
      field.values.push_back(static_cast<float>(
          slope *
          (normal.dot(field.frame.toWorld(Index3(field.blocks.origin(b) + leafOffset(i)))) - offset)));
  return field;
}

std::vector<float> closeTo(const BlockField& field) {
  std::vector<float> close;
  for (const float value : field.values) close.push_back(std::abs(value) < kVoxel ? 1.0f : 0.0f);
  return close;
}

class Slanted : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Degrees, Slanted, testing::Values(0.0, 30.0, 60.0, 75.0));

TEST_P(Slanted, PlanesLieWhereTheResidualsSayWhateverTheSlopeOfTheField) {
  const double angle = GetParam() * 3.14159265 / 180;
  const PlaneView plane(Vector3d(0, std::sin(angle), std::cos(angle)), Vector3d(0, 0, 1));
  for (const double slope : {1.0, 0.7}) {
    for (const double offset : {-0.5 * kVoxel, 0.0, 0.3 * kVoxel}) {
      BlockField field = planeField(plane.normal, offset, slope);
      const std::vector<float> close = closeTo(field);
      const MeasuredField residual = measureResiduals(plane.judged, close, field);
      std::size_t measured = 0;
      for (std::size_t i = 0; i < close.size(); ++i) {
        if (!(residual.weight[i] > 0)) continue;
        ++measured;
        ASSERT_NEAR(residual.distance[i], offset, 0.01 * kVoxel);
      }
      EXPECT_GT(measured, 300u);
    }
  }
}

TEST(MeasureResiduals, ASurfaceSeenFromBehindIsNotMeasured) {
  const PlaneView plane(Vector3d(0, 0, 1), Vector3d(0, 0, -1));  // its outside looks away from the sensor
  BlockField field = planeField(Vector3d(0, 0, 1), 0);
  const MeasuredField residual = measureResiduals(plane.judged, closeTo(field), field);
  for (const float weight : residual.weight) ASSERT_EQ(weight, 0);
}

TEST(MeasureResiduals, DepthsAreNotInterpolatedAcrossAnEdge) {
  PlaneView plane(Vector3d(0, 0, 1), Vector3d(0, 0, 1));
  Image<float>& depth = plane.judged.views[0].depth;
  for (int y = 0; y < depth.height(); ++y)
    for (int x = 100; x < depth.width(); ++x) depth(x, y) = 2.0f;
  BlockField field = planeField(plane.normal, 0);
  const MeasuredField residual = measureResiduals(plane.judged, closeTo(field), field);
  std::size_t measured = 0;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    if (!(residual.weight[i] > 0)) continue;
    ++measured;
    ASSERT_NEAR(residual.distance[i], 0, 0.01 * kVoxel);
  }
  EXPECT_GT(measured, 300u);
}

TEST(MeasureDistances, AreThoseOfThePlaneAtTheVoxelsThatAreAsked) {
  const PlaneView plane(Vector3d(0, 0, 1), Vector3d(0, 0, 1));
  BlockField sides = planeField(plane.normal, 0);
  const BlockField truth = sides;
  const std::vector<float> wanted = closeTo(sides);
  for (float& side : sides.values) side = side > 0 ? 1.0f : -1.0f;
  JudgedViews judged = plane.judged;
  judged.views[0].incidence = Image<float>(200, 200, 1.0f);
  const MeasuredField measured = measureDistances(judged, sides, wanted);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] > 0) {
      ASSERT_NEAR(measured.distance[i], truth.values[i], 0.02 * kVoxel);
    } else {
      ASSERT_TRUE(std::isnan(measured.distance[i]));
    }
  }
}

}  // namespace
}  // namespace vdbfuse
