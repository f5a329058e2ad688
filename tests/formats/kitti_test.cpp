// SPDX-License-Identifier: Apache-2.0
#include "formats/kitti.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "formats/kitti_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::floatBytes;
using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

constexpr const char* kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0\n";

// Three sweeps of a few points, two metres in front of scanners at x = 0, 1, 2.
struct Folder : TemporaryFolder {
  Folder() {
    std::filesystem::create_directory(*this / "velodyne");
    for (const char* name : {"000000", "000001", "000002"})
      writeText(*this / ("velodyne/" + std::string(name) + ".bin"), sweep());
    writeText(*this / "poses.txt",
              std::string(kIdentity) + "1 0 0 1 0 1 0 0 0 0 1 0\n1 0 0 2 0 1 0 0 0 0 1 0\n");
  }
  static std::string sweep() {
    return floatBytes({2, 0, 0, 9, 2, 0.1F, 0, 9, 2, 0, 0.1F, 9, 0, 0, 0, 9}) +
           floatBytes({std::numeric_limits<float>::quiet_NaN(), 0, 0, 9});
  }
  DepthSet read(const ReadOptions& options = {}) const { return readKitti(path(), options); }
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); }), root = path().string();
    return message.starts_with(root) ? message.substr(root.size()) : message;
  }
};

// The nearest depth and its point in the world.
Eigen::Vector3d pointAhead(const DepthSet& set, std::size_t index) {
  const View view = set.views.load(index);
  const auto seen = project(view.projection, Eigen::Vector3d(0, 0, 2));
  return worldPoint(view, nearestPixel(seen->x), nearestPixel(seen->y));
}

TEST(Kitti, SweepsHaveTheirPosesInTheOrderOfTheirNames) {
  const Folder folder;
  const DepthSet set = folder.read();
  ASSERT_EQ(set.views.size(), 3U);
  EXPECT_EQ(set.views.header(2).name, "000002");
  EXPECT_LT((pointAhead(set, 2) - Eigen::Vector3d(4, 0, 0)).norm(), 0.06);
  const View view = set.views.load(0);
  EXPECT_EQ(std::count_if(view.map.depth.begin(), view.map.depth.end(), [](float d) { return d > 0; }), 3);
}

TEST(Kitti, PosesOfTheCameraAreBroughtToTheLaserByTheCalibration) {
  const Folder folder;
  // camera0: x right, y down, z forward, half a metre above the laser.
  writeText(folder / "calib.txt", "P0: 7 0 6 0 0 7 1 0 0 0 1 0\nTr: 0 -1 0 0 0 0 -1 0.5 1 0 0 0\n");
  const DepthSet set = folder.read();
  EXPECT_LT((pointAhead(set, 1) - Eigen::Vector3d(1, 0.5, 2)).norm(), 0.06);
  EXPECT_EQ(set.reading.pose, "3x4 world_from_camera0, with camera0_from_lidar of calib.txt");
  writeText(folder / "calib.txt", "P0: 1\n");
  EXPECT_EQ(folder.complaint(), "/calib.txt: expected a line Tr: with 12 numbers, found none");
  writeText(folder / "calib.txt", "P0: 1\nTr: 1 2 3\n");
  EXPECT_EQ(folder.complaint(),
            "/calib.txt: line 2: expected the 12 numbers of a 3x4 matrix, found 'Tr: 1 2 3'");
}

TEST(Kitti, MoreLinesThanSweepsBelongToTheNumbersOfTheSweeps) {
  const Folder folder;
  std::filesystem::remove(folder / "velodyne/000001.bin");
  EXPECT_LT((pointAhead(folder.read(), 1) - Eigen::Vector3d(4, 0, 0)).norm(), 0.06);
  std::filesystem::rename(folder / "velodyne/000002.bin", folder / "velodyne/x.bin");
  EXPECT_EQ(folder.complaint(), "/poses.txt: expected a line for the sweep x.bin, found 3 lines");
  writeText(folder / "poses.txt", "");
  EXPECT_EQ(folder.complaint(), "/poses.txt: expected a line for the sweep 000000.bin, found 0 lines");
}

TEST(Kitti, PosesMayBeFilesOfTheirOwn) {
  const Folder folder;
  std::filesystem::create_directory(folder / "poses");
  writeText(folder / "poses/000000.txt", "1 0 0 5 0 1 0 0 0 0 1 0\n");
  writeText(folder / "poses/000001.txt", "1 0 0 6\n0 1 0 0\n0 0 1 0\n");
  writeText(folder / "poses/000002.txt", "1 0 0 7\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const DepthSet set = folder.read();
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(set.views.header(i).world_from_camera.translation().x(), 5.0 + static_cast<double>(i));
  std::filesystem::remove(folder / "poses/000001.txt");
  EXPECT_EQ(folder.complaint(),
            "/poses/000001.txt: expected the pose of 000001.bin, found nothing of that name");
}

TEST(Kitti, PosesAreFoundWhereKittiKeepsThem) {
  const TemporaryFolder root;
  std::filesystem::create_directories(root / "poses");
  std::filesystem::create_directories(root / "sequences/07/velodyne");
  writeText(root / "sequences/07/velodyne/000000.bin", Folder::sweep());
  EXPECT_EQ(messageOf<IoError>([&] { readDepthSet(root / "sequences/07"); }),
            (root / "sequences/07").string() + ": expected poses.txt or poses/*.txt, found none");
  writeText(root / "poses/07.txt", kIdentity);
  EXPECT_EQ(readDepthSet(root / "sequences/07/").format, "kitti");
}

TEST(Kitti, BrokenFilesAreRefused) {
  const Folder folder;
  writeText(folder / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_EQ(folder.complaint(),
            "/poses.txt: line 1: expected the 12 numbers of a 3x4 matrix, found '1 0 0 0 0 1 0 0 0 0 1'");
  writeText(folder / "poses.txt", std::string(kIdentity) + "1 0 0 nan 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(folder.complaint(), testing::StartsWith("/poses.txt: line 2: expected the 12 numbers"));
  writeText(folder / "poses.txt", std::string(kIdentity) + "3 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(folder.complaint(),
            "/poses.txt: line 2: expected a rotation, found a matrix R with |RᵀR - 1| = 8");
  const Folder cut;
  writeText(cut / "velodyne/000001.bin", Folder::sweep() + "abc");
  EXPECT_EQ(cut.complaint(),
            "/velodyne/000001.bin: byte 80: expected points of 16 bytes (x y z intensity), found the end of "
            "the file");
  writeText(cut / "velodyne/000001.bin", "");
  EXPECT_THAT(cut.complaint(), testing::StartsWith(": scan 000001: expected points that make a depth map"));
  const TemporaryFolder empty;
  EXPECT_EQ(messageOf<IoError>([&] { readKitti(empty.path(), {}); }),
            empty.path().string() + ": expected sweeps (velodyne/*.bin), found none");
}

TEST(Kitti, StrayPointFarFromTheOthersMakesNoImageOfEmptiness) {
  const Folder folder;
  std::vector<float> points = {-1, -1, 3, 0};
  for (int i = 0; i < 5000; ++i) {
    const auto across = static_cast<float>(i % 50) * 3e-4F, up = static_cast<float>(i / 50) * 1.5e-4F;
    points.insert(points.end(), {1, across, up, 0});
  }
  writeText(folder / "velodyne/000000.bin", floatBytes(points));
  EXPECT_LT(folder.read().views.load(0).map.depth.size(), 1500000U);
}

TEST(Kitti, LimitsAndScaleAreObeyedAndCamerasRefused) {
  const Folder folder;
  ReadOptions options;
  options.depth_scale = 2;
  options.max_depth = 4.001;
  const View view = folder.read(options).views.load(0);
  EXPECT_EQ(*std::max_element(view.map.depth.begin(), view.map.depth.end()), 4.0F);
  options.depth_kind = DepthKind::Z;
  EXPECT_THROW(folder.read(options), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
