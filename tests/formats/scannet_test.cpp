// SPDX-License-Identifier: Apache-2.0
#include "formats/scannet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "formats/camera_samples.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

struct TinyScannet : TemporaryFolder {
  TinyScannet() { test::writeScannet(path()); }
  DepthSet read() const { return readDepthSet(path()); }
  std::string complaint() const {
    return messageOf<IoError>([&] { read(); }).substr(path().string().size());
  }
};

constexpr const char* kLost =
    "-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n-inf -inf -inf -inf\n";

TEST(Scannet, GivesPosesCamerasAndDepths) {
  const TinyScannet folder;
  test::expectSameViews(folder.read().views, test::tinyViews(), 0.00051);
}

TEST(Scannet, PicturesHaveACameraOfTheirOwn) {
  const TinyScannet folder;
  writeText(folder / "intrinsic/extrinsic_color.txt", "1 0 0 0.05\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  const ViewHeader header = folder.read().views.header(1);
  ASSERT_TRUE(header.color_sensor);
  EXPECT_EQ(imageWidth(header.color_sensor->projection), 24);
  const RigidTransform depth_from_color =
      header.world_from_camera.inverse() * header.color_sensor->world_from_camera;
  EXPECT_NEAR(depth_from_color.translation().x(), 0.05, 1e-9);
}

TEST(Scannet, FramesThatTheTrackerLostAreLeftOutWithANote) {
  const TinyScannet folder;
  writeText(folder / "pose/1.txt", kLost);
  const DepthSet set = folder.read();
  EXPECT_EQ(set.views.size(), 2u);
  EXPECT_THAT(set.notes, testing::Contains("1 frame whose pose is not finite left out"));
  writeText(folder / "pose/0.txt", kLost);
  writeText(folder / "pose/2.txt", kLost);
  EXPECT_EQ(folder.complaint(), ": expected a finite pose, found 3 poses that are none");
}

TEST(Scannet, FramesAreOrderedByTheirNumbers) {
  const TinyScannet folder;
  for (const char* name : {"depth/1.png", "pose/1.txt"}) {
    const std::filesystem::path path = folder / name;
    std::filesystem::rename(path, path.parent_path() / ("10" + path.extension().string()));
  }
  const DepthSet set = folder.read();
  EXPECT_EQ(set.views.header(1).name, "2");
  EXPECT_EQ(set.views.header(2).name, "10");
}

TEST(Scannet, MissingAndBrokenFilesAreNamed) {
  const TinyScannet folder;
  writeText(folder / "pose/1.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  EXPECT_EQ(folder.complaint(), "/pose/1.txt: line 4: expected a 4x4 pose matrix, found the end of the file");
  writeText(folder / "pose/1.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 nan 1\n");
  EXPECT_EQ(folder.complaint(), "/pose/1.txt: line 4: expected a finite number, found 'nan'");
  std::filesystem::remove(folder / "pose/1.txt");
  EXPECT_EQ(folder.complaint(), "/pose/1.txt: expected the pose of depth/1.png, found nothing of that name");
  std::filesystem::remove(folder / "intrinsic/intrinsic_depth.txt");
  EXPECT_EQ(folder.complaint(), ": expected intrinsic/intrinsic_depth.txt, or --intrinsics, found none");
}

}  // namespace
}  // namespace vdbfuse
