// SPDX-License-Identifier: Apache-2.0
#include "formats/arkit.h"

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
using test::readText;
using test::TemporaryFolder;
using test::writeText;

std::string complaint(const TemporaryFolder& folder) {
  return messageOf<IoError>([&] { readDepthSet(folder.path()); }).substr(folder.path().string().size());
}

TEST(Arkit, PolycamCamerasAreBroughtToTheSizeOfTheDepthMaps) {
  const TemporaryFolder folder;
  test::writePolycam(folder.path());
  const DepthSet set = readDepthSet(folder.path());
  test::expectSameViews(set.views, test::tinyViews(), 0.00051);
  EXPECT_EQ(set.views.load(0).map.confidence(3, 3), 255);
}

TEST(Arkit, ScannerAppFramesAreRead) {
  const TemporaryFolder folder;
  test::writeScannerApp(folder.path());
  const DepthSet set = readDepthSet(folder.path());
  test::expectSameViews(set.views, test::tinyViews(), 0.00051);
  EXPECT_EQ(set.views.load(0).map.color(0, 0), (Rgb8{9, 8, 7}));
  EXPECT_THAT(set.notes, testing::ElementsAre("colour for 1 of 3 views"));
}

TEST(Arkit, CamerasWithoutDepthAreLeftOutWithANote) {
  const TemporaryFolder folder;
  test::writePolycam(folder.path());
  std::filesystem::remove(folder / "keyframes/depth/1.png");
  const DepthSet set = readDepthSet(folder.path());
  EXPECT_EQ(set.views.size(), 2u);
  EXPECT_THAT(set.notes, testing::Contains("1 camera without a depth map left out"));
}

TEST(Arkit, BrokenPolycamCamerasAreNamed) {
  const TemporaryFolder folder;
  test::writePolycam(folder.path());
  const std::string file = "keyframes/corrected_cameras/0.json", good = readText(folder / file);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    writeText(folder / file, text);
    return complaint(folder);
  };
  EXPECT_EQ(changed("\"t_21\"", "\"u_21\""), "/" + file + ": expected a field 't_21', found none");
  EXPECT_EQ(changed("\"width\": 96", "\"width\": -1"),
            "/" + file + ": width: expected a whole number from 1 to 65536, found -1");
  EXPECT_EQ(changed("\"width\": 96", "\"width\": \"96\""),
            "/" + file + ": width: expected a number, found a string");
  EXPECT_EQ(changed("{", "["), "/" + file + ": line 1: expected JSON, found something else");
  EXPECT_EQ(changed("{", "{\"t_00\": 5, \"x\": {").substr(0, 60).find("/" + file), 0u);
}

TEST(Arkit, BrokenScannerAppFramesAreNamed) {
  const TemporaryFolder folder;
  test::writeScannerApp(folder.path());
  const std::string good = readText(folder / "frame_00001.json");
  writeText(folder / "frame_00001.json", "{\"intrinsics\": [1, 2], \"cameraPoseARFrame\": []}");
  EXPECT_EQ(complaint(folder), "/frame_00001.json: intrinsics: expected 9 numbers, found 2");
  writeText(folder / "frame_00001.json", good);
  std::filesystem::remove(folder / "frame_00000.png");
  EXPECT_EQ(complaint(folder),
            ": expected a picture frame_N.jpg, whose size is that of the intrinsics, found none");
}

}  // namespace
}  // namespace vdbfuse
