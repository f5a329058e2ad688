// SPDX-License-Identifier: Apache-2.0
#include "formats/stanford.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "formats/range_scan.h"
#include "formats/stanford_sample.h"
#include "formats/tiny_scene.h"
#include "io/shared_data.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

struct TinyScans : TemporaryFolder {
  TinyScans() { test::writeStanfordAscii(path()); }
  std::filesystem::path scan() const { return *this / "scan1.ply"; }
  std::filesystem::path conf() const { return *this / "scans.conf"; }
  DepthSet read(const ReadOptions& options = {}) const { return readStanford(path(), options); }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
  std::string complaintAboutConf(const std::string& text) const {
    writeText(conf(), text);
    return complaint();
  }
  // Replaces the first `from` in the second scan.
  std::string complaintAboutScan(const std::string& from, const std::string& to) const {
    const std::string good = readText(scan());
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    writeText(scan(), text);
    const std::string message = complaint();
    writeText(scan(), good);
    return message;
  }
};

TEST(Stanford, PoseTurnsByTheTransposeOfTheQuaternion) {
  const double half = std::sqrt(0.5);
  const RigidTransform pose = stanfordPose({1, 2, 3}, 0, 0, half, half);
  EXPECT_TRUE((pose * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 1, 3), 1e-12));
  const RigidTransform plain = stanfordPose({1, 2, 3}, 0, 0, -half, half);
  EXPECT_TRUE((plain * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
}

TEST(Stanford, SheetsOfLightAreFoundFromTheirPoints) {
  const TinyScans folder;
  const DepthSet set = folder.read();
  const std::vector<View> truth = test::tinyPushBroomViews();
  EXPECT_EQ(set.views.header(0).name, "scan0");
  EXPECT_EQ(set.notes, std::vector<std::string>{"2 scans by a sheet of light moved sideways, points 0 to 0 "
                                                "pixels off the fitted sensor"});
  const auto found = std::get<PushBroom>(set.views.header(1).projection),
             sensor = std::get<PushBroom>(truth[1].projection);
  EXPECT_NEAR(found.x_step, sensor.x_step, 1e-6);
  EXPECT_NEAR(found.x_shear, sensor.x_shear, 1e-5);
  EXPECT_NEAR(found.fy, sensor.fy, 1e-3);
  EXPECT_NEAR(found.cy, sensor.cy, 1e-3);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const View view = set.views.load(i);
    ASSERT_TRUE(view.map.depth.sameSize(truth[i].map.depth));
    EXPECT_EQ(view.map.depth(0, 0), kInvalidDepth);
    for (int x = 0; x < 40; ++x)
      EXPECT_LT((worldPoint(view, x, 20) - worldPoint(truth[i], x, 20)).norm(), 1e-4) << i << ", " << x;
  }
}

TEST(Stanford, PinholesAreFoundFromTheirPoints) {
  const TemporaryFolder folder;
  test::writeStanfordPinhole(folder.path());
  test::expectSameViews(readStanford(folder.path(), {}).views, test::tinyViews(), 1e-5);
}

TEST(Stanford, BinaryScansAreThoseOfText) {
  const TinyScans text;
  const TemporaryFolder binary;
  test::writeStanfordBinary(binary.path());
  const Image<float> a = text.read().views.load(1).map.depth,
                     b = readStanford(binary / "scans.conf", {}).views.load(1).map.depth;
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a.data()[i], b.data()[i], 1e-6);
}

TEST(Stanford, ScaledPointsKeepTheirSensor) {
  const TinyScans folder;
  ReadOptions options;
  options.depth_scale = 1000;
  options.max_depth = 2000;
  const View plain = folder.read().views.load(0), large = folder.read(options).views.load(0);
  EXPECT_NEAR(std::get<PushBroom>(large.projection).x_step,
              1000 * std::get<PushBroom>(plain.projection).x_step, 1e-3);
  for (std::size_t i = 0; i < plain.map.depth.size(); ++i) {
    const float depth = plain.map.depth.data()[i];
    if (std::abs(depth - 2.0F) > 1e-3F) {
      ASSERT_NEAR(large.map.depth.data()[i], depth > 2 ? 0 : 1000 * depth, 0.1);
    }
  }
}

TEST(Stanford, WhatScansDoNotHaveIsRefused) {
  const TinyScans folder;
  ReadOptions options;
  options.intrinsics = {{5, 6, 1, 2}};
  EXPECT_THROW(folder.read(options), InvalidArgument);
  options = {};
  options.depth_kind = DepthKind::Range;
  EXPECT_THROW(folder.read(options), InvalidArgument);
}

TEST(Stanford, BrokenConfigurationsAreRefusedWithTheirLine) {
  const TinyScans folder;
  const std::string pose = " 0 0 0 0 0 0 1\n";
  EXPECT_EQ(folder.complaintAboutConf("mesh a.ply\n"),
            "/scans.conf: expected a line 'bmesh FILE tx ty tz qx qy qz qw', found none");
  EXPECT_EQ(folder.complaintAboutConf("\nscan a.ply" + pose),
            "/scans.conf: line 2: expected bmesh, mesh or camera, found 'scan'");
  EXPECT_EQ(folder.complaintAboutConf("bmesh scan0.ply 0 0 0\n"),
            "/scans.conf: line 1: expected bmesh FILE tx ty tz qx qy qz qw, found 5 words");
  EXPECT_EQ(folder.complaintAboutConf("bmesh scan0.ply 0 0 nan 0 0 0 1\n"),
            "/scans.conf: line 1: expected a finite number, found 'nan'");
  EXPECT_EQ(folder.complaintAboutConf("bmesh scan0.ply 0 0 0 0 0 0 0\n"),
            "/scans.conf: line 1: expected a quaternion of length 1, found length 0");
  EXPECT_EQ(folder.complaintAboutConf("bmesh ../scan0.ply" + pose),
            "/scans.conf: line 1: expected a path inside the data set, found '../scan0.ply'");
  EXPECT_EQ(folder.complaintAboutConf("bmesh none.ply" + pose),
            "/none.ply: expected a file to read, found none");
  writeText(folder / "other.conf", "");
  EXPECT_EQ(folder.complaint(), ": expected one .conf file, found other.conf and scans.conf");
}

TEST(Stanford, LinesThatAreNotUsedAreNoted) {
  const TinyScans folder;
  writeText(folder.conf(), "mesh floor.ply\n" + readText(folder.conf()));
  EXPECT_EQ(folder.read().notes.back(), "1 mesh line left out");
}

TEST(Stanford, BrokenScansAreRefused) {
  const TinyScans folder;
  const auto complaint = [&](const char* from, const char* to) {
    return folder.complaintAboutScan(from, to);
  };
  EXPECT_EQ(complaint("obj_info num_cols 40\n", ""),
            "/scan1.ply: expected a line 'obj_info num_cols N' in the header, found none");
  EXPECT_EQ(complaint("num_cols 40", "num_cols -40"),
            "/scan1.ply: obj_info num_cols: expected a whole number from 1 to 65535, found '-40'");
  EXPECT_EQ(complaint("num_cols 40", "num_cols 41"),
            "/scan1.ply: element range_grid: expected 1230 entries (num_cols x num_rows), found 1200");
  EXPECT_EQ(complaint("range_grid 1200", "range_grid 1200000"),
            "/scan1.ply: line 1211: expected 1200000 elements 'range_grid', found room for 3643");
  EXPECT_EQ(complaint("\n1 7\n", "\n1 -7\n"),
            "/scan1.ply: entry 7 of range_grid: expected no index or one below 1199, found -7.000000");
  EXPECT_EQ(complaint("\n1 7\n", "\n2 7 7\n"),
            "/scan1.ply: entry 7 of range_grid: expected no index or one below 1199, found 2 indices");
  EXPECT_EQ(complaint("\n1 7\n", "\n1 nan\n"),
            "/scan1.ply: entry 7 of range_grid: expected no index or one below 1199, found nan");
  EXPECT_EQ(complaint("element range_grid", "element grid"),
            "/scan1.ply: expected the element 'range_grid', found none of that name");
}

TEST(Stanford, ScansOfNoKnownSensorAreRefused) {
  const TinyScans folder;
  std::string text =
      "ply\nformat ascii 1.0\nobj_info num_cols 5\nobj_info num_rows 5\nelement vertex 25\nproperty float "
      "x\nproperty float y\nproperty float z\nelement range_grid 25\nproperty list uchar int "
      "vertex_indices\nend_header\n";
  for (int i = 0; i < 25; ++i)
    text += std::to_string(i * i % 7) + " " + std::to_string(i * i % 11) + " " + std::to_string(i % 3) + "\n";
  for (int i = 0; i < 25; ++i) text += "1 " + std::to_string(i) + "\n";
  writeText(folder.scan(), text);
  const std::string message = folder.complaint();
  EXPECT_EQ(message.find("/scan1.ply: expected a scan by a pinhole or by a sheet of light moved sideways"),
            0u)
      << message;
}

TEST(RangeScan, DepthsAreTakenToTheCentresOfPixels) {
  // A slanted plane, its odd rows half a column aside, seen by parallel rays of steps of 1.
  const Orthographic sensor{6, 5, 0, 1, 0, 1};
  PointImage points = noPoints(6, 5);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x) {
      const float u = static_cast<float>(x) + (y % 2 == 0 ? 0.25F : -0.25F), v = static_cast<float>(y) - 0.1F;
      points(x, y) = {u, v, 10 + 0.5F * u + 0.25F * v};
    }
  }
  points(2, 2) = Eigen::Vector3f::Constant(std::nanf(""));
  const Image<float> depth = depthAtCentres(points, sensor);
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 6; ++x)
      EXPECT_NEAR(depth(x, y), x == 2 && y == 2 ? 0 : 10 + 0.5 * x + 0.25 * y, 1e-5) << x << ", " << y;
  }
}

// Median distance in depth between the points of scan a and what scan b measured where they fall.
double disagreement(const View& a, const View& b) {
  std::vector<double> found;
  const RigidTransform b_from_a = b.world_from_camera.inverse() * a.world_from_camera;
  for (int y = 0; y < a.map.depth.height(); ++y) {
    for (int x = 0; x < a.map.depth.width(); ++x) {
      if (a.map.depth(x, y) == kInvalidDepth) continue;
      const auto hit = project(b.projection, b_from_a * unproject(a.projection, x, y, a.map.depth(x, y)));
      if (!hit || !b.map.depth.contains(nearestPixel(hit->x), nearestPixel(hit->y))) continue;
      const float there = b.map.depth(nearestPixel(hit->x), nearestPixel(hit->y));
      if (there != kInvalidDepth && std::abs(there - hit->depth) < 0.005)
        found.push_back(std::abs(there - hit->depth));
    }
  }
  if (found.size() < 3000) return std::nan("");
  const auto middle = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2);
  std::nth_element(found.begin(), middle, found.end());
  return *middle;
}

TEST(RealData, BunnyScansAgreeWithEachOther) {
  const auto folder = test::sharedData("bunny-scans");
  if (!folder) GTEST_SKIP() << "the real data set bunny-scans is not on this machine (set VDBFUSE_DATA)";
  const DepthSet set = readDepthSet(*folder);
  EXPECT_EQ(set.format, "stanford");
  ASSERT_EQ(set.views.size(), 10u);
  ASSERT_EQ(set.notes.size(), 1u);
  std::vector<View> views;
  for (std::size_t i = 0; i < set.views.size(); ++i) views.push_back(set.views.load(i));
  int pairs = 0;
  for (const View& a : views) {
    for (const View& b : views) {
      // Scans from opposite sides see other parts, and the ears' two sides.
      const double facing = a.world_from_camera.linear().col(2).dot(b.world_from_camera.linear().col(2));
      const double apart = &a == &b || facing < 0.5 ? std::nan("") : disagreement(a, b);
      if (!std::isfinite(apart)) continue;
      EXPECT_LT(apart, 0.0005) << a.name << " in " << b.name;
      ++pairs;
    }
  }
  EXPECT_GE(pairs, 15);
}

}  // namespace
}  // namespace vdbfuse
