// SPDX-License-Identifier: Apache-2.0
#include "formats/point_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;

constexpr double kDegree = std::numbers::pi / 180;

PointScan organised(const View& view) { return {pointsOf(view), {}}; }

PointScan loose(const View& view) {
  PointScan scan;
  for (const Eigen::Vector3f& p : pointsOf(view)) scan.loose.push_back(p);
  return scan;
}

Eigen::Vector3f pointAt(double azimuth, double elevation, double range) {
  const Spherical sensor{1, 1, azimuth, 1, elevation, 1};
  return unproject(sensor, 0, 0, range).cast<float>();
}

// A sphere of radius 2 around the sensor, a point a degree from `first` to `last` in azimuth.
PointScan band(int first, int last) {
  PointScan scan;
  for (int azimuth = first; azimuth < last; ++azimuth) {
    for (int elevation = -10; elevation <= 10; ++elevation)
      scan.loose.push_back(pointAt((azimuth + 0.5) * kDegree, (elevation + 0.5) * kDegree, 2));
  }
  return scan;
}

ScanSource sourceOf(const PointScan& scan) {
  ScanSource source;
  source.headers.push_back({"one", {}, RigidTransform::Identity(), std::nullopt});
  source.load = [scan](std::size_t) { return scan; };
  source.pose = "none";
  return source;
}

DepthSet setOf(const PointScan& scan, const ReadOptions& options = {}) {
  return setOfScans("in", sourceOf(scan), options, "test");
}

TEST(PointViews, ScannersAxesBecomeOurs) {
  EXPECT_EQ(cameraFromScanner() * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(cameraFromScanner() * Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-1, 0, 0));
  EXPECT_EQ(cameraFromScanner() * Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, -1, 0));
}

TEST(PointViews, ScansOfOneScannerShareASensorThatAFewOfThemTell) {
  ScanSource source = sourceOf(band(0, 90));
  source.headers.resize(40, source.headers.front());
  source.sensors = ScanSource::Sensors::OneForAll;
  const auto reads = std::make_shared<int>(0);
  source.load = [reads](std::size_t index) {
    ++*reads;
    return band(index < 20 ? 0 : 60, index < 20 ? 90 : 120);
  };
  const DepthSet set = setOfScans("in", source, {}, "test");
  EXPECT_EQ(*reads, 8);
  const auto sensor = std::get<Spherical>(set.views.header(0).projection);
  EXPECT_EQ(std::get<Spherical>(set.views.header(39).projection), sensor);
  EXPECT_NEAR(sensor.width * sensor.azimuth_step, 120 * kDegree, 3 * kDegree);
  // All points of every scan fall into it.
  for (const std::size_t index : {0, 39}) {
    const Image<float> depth = set.views.load(index).map.depth;
    EXPECT_GT(std::count_if(depth.begin(), depth.end(), [](float d) { return d > 0; }),
              index < 20 ? 1700 : 1100);
  }
}

TEST(PointViews, OrganisedScansOfATurningScannerAreExact) {
  for (const View& view : test::tinySphericalViews()) {
    const ScanProjection found = projectionOf(organised(view), std::nullopt);
    EXPECT_EQ(found.origin, ScanProjection::Origin::Fitted);
    const auto truth = std::get<Spherical>(view.projection), scanner = std::get<Spherical>(found.projection);
    EXPECT_NEAR(scanner.azimuth_step, truth.azimuth_step, 1e-6);
    EXPECT_NEAR(scanner.elevation0, truth.elevation0, 1e-6);
    const Image<float> depth = depthOf(organised(view), found);
    ASSERT_TRUE(depth.sameSize(view.map.depth));
    for (std::size_t i = 0; i < depth.size(); ++i)
      ASSERT_NEAR(depth.data()[i], view.map.depth.data()[i], 1e-4) << i;
  }
}

TEST(PointViews, OrganisedScansOfAPinholeAreExact) {
  const View view = test::tinyViews(1)[0];
  const ScanProjection found = projectionOf(organised(view), std::nullopt);
  EXPECT_EQ(found.origin, ScanProjection::Origin::Fitted);
  ASSERT_TRUE(std::holds_alternative<Pinhole>(found.projection));
  const Image<float> depth = depthOf(organised(view), found);
  for (std::size_t i = 0; i < depth.size(); ++i) ASSERT_NEAR(depth.data()[i], view.map.depth.data()[i], 1e-5);
}

TEST(PointViews, FullTurnCloses) {
  const auto scanner = std::get<Spherical>(projectionOf(band(-180, 180), std::nullopt).projection);
  EXPECT_DOUBLE_EQ(scanner.width * scanner.azimuth_step, 2 * std::numbers::pi);
  EXPECT_NEAR(scanner.azimuth_step, kDegree, 0.1 * kDegree);
}

TEST(PointViews, SeamLiesAtTheEdgeOfTheImage) {
  // From 120 degrees over the back to -100: the image begins after the gap.
  const PointScan scan = band(120, 260);
  const ScanProjection found = projectionOf(scan, kDegree);
  const auto scanner = std::get<Spherical>(found.projection);
  EXPECT_EQ(scanner.width, 140);
  EXPECT_NEAR(scanner.azimuth0, 120.5 * kDegree, 1e-6);
  const Image<float> depth = depthOf(scan, found);
  for (int x = 0; x < scanner.width; ++x) EXPECT_NEAR(depth(x, 10), 2, 1e-5) << x;
}

TEST(PointViews, StepIsObeyedOrAsThePointsAreSpaced) {
  const PointScan scan = band(-40, 40);
  EXPECT_EQ(std::get<Spherical>(projectionOf(scan, 0.01).projection).elevation_step, 0.01);
  EXPECT_NEAR(std::get<Spherical>(projectionOf(scan, std::nullopt).projection).elevation_step, kDegree,
              0.1 * kDegree);
}

TEST(PointViews, FewScatteredPointsMakeNoLargeImage) {
  PointScan scan;
  for (int i = 0; i < 1000; ++i) scan.loose.push_back(pointAt(1e-6 * i, 0, 1));
  scan.loose.push_back(pointAt(3, -1.2, 1));
  scan.loose.push_back(pointAt(-1.5, 1.2, 1));
  const Projection projection = projectionOf(scan, std::nullopt).projection;
  EXPECT_LE(imageWidth(projection) * imageHeight(projection), 2 * (64 * 1002 + 65536));
}

TEST(PointViews, SplatKeepsTheNearestAtItsOwnRange) {
  PointScan scan = band(-20, 20);
  scan.loose.push_back(pointAt(0.4 * kDegree, 0.6 * kDegree, 1.5));
  scan.loose.push_back(pointAt(0.6 * kDegree, 0.4 * kDegree, 3));
  scan.loose.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0, 1);
  scan.loose.emplace_back(0, 0, 0);
  const ScanProjection found = projectionOf(scan, kDegree);
  EXPECT_EQ(found.origin, ScanProjection::Origin::Splat);
  const Image<float> depth = depthOf(scan, found);
  const auto seen = project(found.projection, pointAt(0.5 * kDegree, 0.5 * kDegree, 1).cast<double>());
  EXPECT_NEAR(depth(nearestPixel(seen->x), nearestPixel(seen->y)), 1.5, 1e-6);
}

TEST(PointViews, LoosePointsOfAScannerLieOnTheSurface) {
  for (const View& view : test::tinySphericalViews()) {
    const DepthSet set = setOf(loose(view));
    const View splatted = set.views.load(0);
    std::size_t valid = 0;
    for (const float d : splatted.map.depth) valid += d != kInvalidDepth ? 1 : 0;
    EXPECT_GT(valid, 200u);
    ASSERT_EQ(set.notes.size(), 1u);
    EXPECT_THAT(set.notes[0], testing::StartsWith("1 scan made into spherical depth maps, a pixel every "));
  }
}

TEST(PointViews, ScaleAndLimitsAreObeyed) {
  ReadOptions options;
  options.depth_scale = 0.5;
  const auto largest = [&] {
    const Image<float> depth = setOf(band(-20, 20), options).views.load(0).map.depth;
    return *std::max_element(depth.begin(), depth.end());
  };
  EXPECT_NEAR(largest(), 1, 1e-6);
  options.max_depth = 0.9;
  EXPECT_EQ(largest(), kInvalidDepth);
}

TEST(PointViews, WhatCannotBeIsRefused) {
  EXPECT_EQ(messageOf<InvalidArgument>([] { projectionOf(PointScan{}, std::nullopt); }),
            "scan: expected points, found none that is finite");
  EXPECT_EQ(messageOf<InvalidArgument>([] { projectionOf(band(-180, 180), 1e-5); }),
            "splat_step: 1e-05 gives an image of more than 2^26 pixels");
  EXPECT_EQ(
      messageOf<IoError>([] { setOf(PointScan{}); }),
      "in: scan one: expected points that make a depth map, found scan: expected points, found none that is "
      "finite");
  EXPECT_EQ(messageOf<IoError>([] { setOfScans("in", ScanSource{}, {}, "test"); }),
            "in: expected a scan, found none");
  ReadOptions options;
  options.depth_kind = DepthKind::Z;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { setOf(band(0, 9), options); }),
            "depth_kind: test holds points, whose depth is the range");
  options = {};
  options.intrinsics = {{1, 1, 1, 1}};
  EXPECT_THROW(setOf(band(0, 9), options), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
