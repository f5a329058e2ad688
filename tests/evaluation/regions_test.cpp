// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/evaluation/regions.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;
using test::messageOf;
using test::TemporaryFolder;
using test::writeText;
using testing::HasSubstr;

std::vector<Region> parse(const std::string& text) {
  const TemporaryFolder folder;
  writeText(folder / "regions.json", text);
  return readRegions(folder / "regions.json");
}

std::string complaint(const std::string& text) {
  const TemporaryFolder folder;
  writeText(folder / "r.json", text);
  const std::string message = messageOf<IoError>([&] { readRegions(folder / "r.json"); });
  return message.substr(folder.path().string().size() + 1);
}

std::string complaintAbout(const std::string& members) {
  return complaint("{\"regions\":[{" + members + "}]}");
}

Vector3d meanOf(const std::vector<Vector3d>& points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

TEST(Regions, EveryShapeIsRead) {
  const auto regions = parse(R"({"version": 1, "regions": [
    {"name": "cavity", "expect": "outside", "shape": "box", "min": [0, 0, 0], "max": [1, 2, 3], "colour": "red"},
    {"name": "head", "expect": "inside", "shape": "sphere", "center": [1, 2, 3], "radius": 0.5},
    {"name": "left leg", "expect": "inside", "shape": "cylinder", "from": [0, 0, 0], "to": [0, 0, 2], "radius": 1},
    {"name": "arm", "expect": "inside", "shape": "oriented_box", "center": [0, 0, 0],
     "axes": [[1, 1, 0], [-1, 1, 0], [0, 0, 1]], "half_extents": [1, 2, 3]}]})");
  ASSERT_EQ(regions.size(), 4u);
  EXPECT_EQ(regions[0].name, "cavity");
  EXPECT_EQ(regions[0].expect, Expectation::Outside);
  EXPECT_EQ(std::get<Box>(regions[0].shape).max(), Vector3d(1, 2, 3));
  EXPECT_EQ(regions[1].expect, Expectation::Inside);
  EXPECT_EQ(std::get<RegionSphere>(regions[1].shape).radius, 0.5);
  EXPECT_EQ(std::get<RegionCylinder>(regions[2].shape).to, Vector3d(0, 0, 2));
  EXPECT_NEAR(std::get<RegionOrientedBox>(regions[3].shape).axes(0, 0), std::sqrt(0.5), 1e-12);
}

TEST(Regions, SamplesOfABoxFillIt) {
  const auto points = sampleRegion(Box(Vector3d(1, 2, 3), Vector3d(2, 4, 6)), 20000, 1);
  Box box;
  for (const Vector3d& p : points) box.extend(p);
  EXPECT_LT((box.min() - Vector3d(1, 2, 3)).norm(), 0.01);
  EXPECT_LT((box.max() - Vector3d(2, 4, 6)).norm(), 0.01);
  EXPECT_LT((meanOf(points) - Vector3d(1.5, 3, 4.5)).norm(), 0.03);
}

TEST(Regions, SamplesOfASphereAreUniformByVolume) {
  const auto points = sampleRegion(RegionSphere{{1, 0, 0}, 2}, 20000, 1);
  std::size_t inner = 0;
  for (const Vector3d& p : points) {
    EXPECT_LE((p - Vector3d(1, 0, 0)).norm(), 2.0);
    inner += (p - Vector3d(1, 0, 0)).norm() < 1;
  }
  EXPECT_NEAR(static_cast<double>(inner) / 20000, 1.0 / 8, 0.01);
}

TEST(Regions, SamplesOfACylinderAreUniformByVolume) {
  const auto points = sampleRegion(RegionCylinder{{0, 0, 1}, {0, 4, 1}, 2}, 20000, 1);
  std::size_t inner = 0;
  for (const Vector3d& p : points) {
    const double r = std::hypot(p.x(), p.z() - 1);
    EXPECT_LE(r, 2 + 1e-12);
    EXPECT_GE(p.y(), 0);
    EXPECT_LE(p.y(), 4);
    inner += r < 1;
  }
  EXPECT_NEAR(static_cast<double>(inner) / 20000, 1.0 / 4, 0.012);
  EXPECT_NEAR(meanOf(points).y(), 2, 0.03);
}

TEST(Regions, SamplesOfAnOrientedBoxLieInIt) {
  RegionOrientedBox box{{1, 1, 1}, Eigen::Matrix3d::Identity(), {3, 2, 1}};
  box.axes = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Vector3d largest = Vector3d::Zero();
  for (const Vector3d& p : sampleRegion(box, 20000, 1)) {
    largest = largest.cwiseMax((box.axes.transpose() * (p - box.center)).cwiseAbs());
  }
  EXPECT_LT((largest - box.half_extents).norm(), 0.01);
  EXPECT_TRUE((largest.array() <= box.half_extents.array() + 1e-12).all());
}

TEST(Regions, WhatIsNoFileOrNoJsonIsRefused) {
  EXPECT_EQ(messageOf<IoError>([] { readRegions("none.json"); }),
            "none.json: expected a file with regions, found none");
  EXPECT_EQ(complaint("{\"regions\": oops}"), "r.json: byte 13: expected JSON, found something else");
  EXPECT_EQ(complaint("[]"), "r.json: expected an object with an array 'regions', found none");
  EXPECT_EQ(complaint("{\"regions\": 3}"), "r.json: expected an object with an array 'regions', found none");
}

TEST(Regions, MessagesNameTheRegionAndItsMember) {
  const std::string start = R"("name": "a", "expect": "inside", )";
  EXPECT_EQ(complaint(R"({"regions":[7]})"), "r.json: expected an object in region 0, found 7");
  EXPECT_EQ(complaintAbout(R"("name": 3)"),
            "r.json: expected the text 'name' in region 0, found {\"name\":3}");
  EXPECT_THAT(complaintAbout(R"("name": "a", "expect": "maybe")"),
              HasSubstr("'expect' to be outside or inside"));
  EXPECT_THAT(complaintAbout(start + R"("shape": "cone")"),
              HasSubstr("'shape' to be box, sphere, cylinder or oriented_box in region 0"));
  EXPECT_THAT(complaintAbout(start + R"("shape": "sphere", "center": [1, 2], "radius": 1)"),
              HasSubstr("three numbers 'center'"));
  EXPECT_THAT(complaintAbout(start + R"("shape": "sphere", "center": [1, 2, 3], "radius": -1)"),
              HasSubstr("the positive number 'radius'"));
  EXPECT_THAT(complaintAbout(start + R"("shape": "box", "min": [0, 0, 0], "max": [1, 0, 1])"),
              HasSubstr("'min' below 'max'"));
  EXPECT_THAT(
      complaintAbout(start + R"("shape": "cylinder", "from": [0, 0, 0], "to": [0, 0, 0], "radius": 1)"),
      HasSubstr("'from' to differ from 'to'"));
  const std::string box = start + R"("shape": "oriented_box", "center": [0, 0, 0], )";
  EXPECT_THAT(complaintAbout(box + R"("half_extents": [1, 1, 1])"), HasSubstr("three vectors 'axes'"));
  EXPECT_THAT(complaintAbout(box + R"("half_extents": [1, 0, 1], "axes": [[1,0,0],[0,1,0],[0,0,1]])"),
              HasSubstr("positive 'half_extents'"));
  EXPECT_THAT(complaintAbout(box + R"("half_extents": [1, 1, 1], "axes": [[1,0,0],[1,1,0],[0,0,1]])"),
              HasSubstr("orthogonal 'axes'"));
}

}  // namespace
}  // namespace vdbfuse
