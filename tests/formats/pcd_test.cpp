// SPDX-License-Identifier: Apache-2.0
#include "formats/pcd.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <sstream>
#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

constexpr int kWidth = 6, kHeight = 5;
const std::string kHalfTurn = "1 2 3 0 0 0 1";  // by 180° around z

View testView() {
  View view;
  view.projection = Pinhole{kWidth, kHeight, 8, 8, 2.5, 2, {}};
  view.world_from_camera.linear() = Eigen::Vector3d(-1, -1, 1).asDiagonal();
  view.world_from_camera.translation() = Eigen::Vector3d(1, 2, 3);
  view.map.depth = Image<float>(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) view.map.depth(x, y) = 1.0f + 0.25f * static_cast<float>(x + y % 2);
  }
  view.map.depth(1, 1) = kInvalidDepth;
  return view;
}

std::string header(const std::string& data, const std::string& viewpoint = kHalfTurn) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
         "COUNT 1 1 1\nWIDTH 6\nHEIGHT 5\nVIEWPOINT " +
         viewpoint + "\nPOINTS 30\nDATA " + data + "\n";
}

std::string binary(const PointImage& points) {
  std::string bytes(points.size() * sizeof(Eigen::Vector3f), '\0');
  std::memcpy(bytes.data(), points.data(), bytes.size());
  return bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  writeText(folder / "a.pcd", content);
  const std::string message = messageOf<IoError>([&] { readDepthSet(folder / "a.pcd"); });
  const std::string path = (folder / "a.pcd").string();
  return message.starts_with(path) ? message.substr(path.size()) : message;
}

TEST(Pcd, BrokenHeadersAreSaidWithTheirLine) {
  const std::string good = header("ascii");
  EXPECT_EQ(refusal(replaced(good, "HEIGHT 5", "HEIGHT 1")),
            ": line 11: expected an organised cloud (WIDTH and HEIGHT above 1), found 6x1");
  EXPECT_EQ(refusal(replaced(good, "POINTS 30", "POINTS 31")),
            ": line 11: expected POINTS 30 (WIDTH x HEIGHT), found 31");
  EXPECT_EQ(refusal(replaced(good, "FIELDS x y z", "FIELDS x y w")),
            ": line 11: expected the field z, found none of that name");
  EXPECT_EQ(refusal(replaced(good, "SIZE 4 4 4", "SIZE 8 4 4")),
            ": line 11: expected the field x as one 4-byte float (SIZE 4, TYPE F), found SIZE 8, TYPE F");
  EXPECT_EQ(refusal(replaced(good, "TYPE F F F", "TYPE F F X")), ": line 5: expected F, I or U, found 'X'");
  EXPECT_EQ(refusal(replaced(good, "WIDTH 6", "WIDTH six")),
            ": line 7: expected a whole number, found 'six'");
  EXPECT_EQ(refusal(replaced(good, "DATA ascii", "DATA morse")),
            ": line 11: expected DATA ascii, binary or binary_compressed, found 'morse'");
  EXPECT_EQ(refusal(replaced(good, "VERSION 0.7", "VERSOIN 0.7")),
            ": line 2: expected a line of a PCD header, found 'VERSOIN'");
  EXPECT_EQ(refusal("# .PCD v0.7\nFIELDS x y z\n"), ": line 3: expected DATA, found the end of the file");
  EXPECT_EQ(refusal(header("ascii", "0 0 0 2 0 0 0")),
            ": line 9: expected VIEWPOINT tx ty tz qw qx qy qz with a quaternion of length 1, found length "
            "2.000000");
  EXPECT_EQ(refusal(header("ascii", "0 0 0 1 0 0")),
            ": line 9: expected a number, found the end of the line");
}

TEST(Pcd, TruncatedBinaryDataAreSaidWithTheirByte) {
  const std::string good = header("binary") + binary(pointsOf(testView()));
  EXPECT_EQ(refusal(good.substr(0, good.size() - 1)), ": byte " + std::to_string(good.size() - 1) +
                                                          ": expected " + std::to_string(good.size()) +
                                                          " bytes, found the end of the file");
}

TEST(Pcd, IsFoundByItsEnding) {
  const TemporaryFolder folder;
  EXPECT_EQ(pcdFormat().detect(folder.path()).fit, Detection::Fit::No);
  writeText(folder / "a.pcd", "");
  writeText(folder / "a.txt", "");
  EXPECT_EQ(pcdFormat().detect(folder.path()).fit, Detection::Fit::Fully);
  EXPECT_EQ(pcdFormat().detect(folder / "a.pcd").fit, Detection::Fit::Fully);
  EXPECT_EQ(pcdFormat().detect(folder / "a.txt").fit, Detection::Fit::No);
}

TEST(Pcd, PointsHaveNoOtherDepthThanZ) {
  const TemporaryFolder folder;
  writeText(folder / "a.pcd", header("ascii"));
  ReadOptions options;
  options.depth_kind = DepthKind::Range;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { readDepthSet(folder / "a.pcd", options); }),
            "depth_kind: pcd holds points, whose depth is z");
}

#ifndef VDBFUSE_TEST_PCL
TEST(Pcd, WithoutThePclPartItIsSaidWhatIsMissing) {
  EXPECT_EQ(refusal(header("binary") + binary(pointsOf(testView()))),
            ": reading PCD needs the PCL part (vdbfuse_pcl), which was not built or is not installed");
}
#else
std::string ascii(const PointImage& points) {
  std::ostringstream text;
  text.precision(9);
  for (const Eigen::Vector3f& p : points) text << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
  return text.str();
}

void expectTestView(const DepthSet& set) {
  ASSERT_EQ(set.views.size(), 1u);
  EXPECT_EQ(set.format, "pcd");
  const View truth = testView(), found = set.views.load(0);
  EXPECT_TRUE(found.world_from_camera.isApprox(truth.world_from_camera, 1e-6));
  EXPECT_NEAR(std::get<Pinhole>(found.projection).fx, 8, 1e-4);
  EXPECT_NEAR(std::get<Pinhole>(found.projection).cx, 2.5, 1e-4);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) EXPECT_NEAR(found.map.depth(x, y), truth.map.depth(x, y), 1e-5);
  }
}

TEST(Pcd, AsciiAndBinaryGiveTheView) {
  const TemporaryFolder folder;
  writeText(folder / "ascii.pcd", header("ascii") + ascii(pointsOf(testView())));
  writeText(folder / "binary.pcd", header("binary") + binary(pointsOf(testView())));
  expectTestView(readDepthSet(folder / "ascii.pcd"));
  expectTestView(readDepthSet(folder / "binary.pcd"));
}

TEST(Pcd, FolderHoldsAViewAFile) {
  const TemporaryFolder folder;
  for (const char* name : {"b.pcd", "a.pcd"})
    writeText(folder / name, header("ascii") + ascii(pointsOf(testView())));
  const DepthSet set = readDepthSet(folder.path());
  ASSERT_EQ(set.views.size(), 2u);
  EXPECT_EQ(set.views.header(0).name, "a");
  EXPECT_EQ(set.views.header(1).name, "b");
}

TEST(Pcd, PointsInTheWorldAreTakenBackByTheViewpoint) {
  PointImage points = pointsOf(testView());
  for (Eigen::Vector3f& p : points) p = (testView().world_from_camera * p.cast<double>()).cast<float>();
  const TemporaryFolder folder;
  writeText(folder / "world.pcd", header("ascii") + ascii(points));
  const DepthSet set = readDepthSet(folder / "world.pcd");
  expectTestView(set);
  EXPECT_THAT(set.notes, testing::ElementsAre("1 cloud in world coordinates, taken back by VIEWPOINT"));
}

TEST(Pcd, ScaleAndRangeOfDepthAreObeyed) {
  const TemporaryFolder folder;
  writeText(folder / "a.pcd", header("ascii") + ascii(pointsOf(testView())));
  ReadOptions options;
  options.depth_scale = 2.0;
  options.max_depth = 2.4;
  const View view = readDepthSet(folder / "a.pcd", options).views.load(0);
  EXPECT_NEAR(view.map.depth(0, 0), 2.0, 1e-5);
  EXPECT_EQ(view.map.depth(kWidth - 1, 0), kInvalidDepth);
}

TEST(Pcd, CloudThatNoCameraTookIsRefused) {
  PointImage points = pointsOf(testView());
  for (int x = 0; x < kWidth; ++x) std::swap(points(x, 0), points(kWidth - 1 - x, kHeight - 1));
  EXPECT_EQ(refusal(header("binary") + binary(points)),
            ": expected points of a pinhole camera, one for each pixel, found points that no pinhole camera "
            "sees at "
            "their pixels");
}

TEST(Pcd, MissingAsciiPointsAreSaid) {
  const std::string good = header("ascii") + ascii(pointsOf(testView()));
  EXPECT_EQ(refusal(good.substr(0, good.size() - 60)),
            ": expected the data that its header announces, found fewer or damaged data");
}
#endif

}  // namespace
}  // namespace vdbfuse
