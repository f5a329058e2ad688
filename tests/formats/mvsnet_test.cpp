// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/formats/mvsnet.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "formats/mvsnet_camera.h"
#include "formats/mvsnet_format.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

View tinyView(double angle) {
  View view;
  view.name = "anything";
  view.projection = Pinhole{6, 4, 7.25, 7.5, 2.4, 1.6, {}};
  view.world_from_camera = Eigen::Translation3d(0.1, -2.0, 1.0 / 3.0) *
                           Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized());
  view.map.depth = Image<float>(6, 4, 1.25f);
  view.map.depth(5, 3) = 2.5f;
  view.map.depth(0, 1) = kInvalidDepth;
  view.map.confidence = Image<float>(6, 4, 0.5f);
  view.map.color = Image<Rgb8>(12, 8, Rgb8{9, 8, 7});
  return view;
}

// Two views written by our writer.
struct TinyFolder : TemporaryFolder {
  TinyFolder() {
    MvsnetWriter writer(path());
    writer.add(tinyView(0.3));
    writer.add(tinyView(2.0));
  }
  DepthSet read(const ReadOptions& options = {}) const { return readMvsnet(path(), options); }
  std::filesystem::path camera() const { return *this / "cams/00000001_cam.txt"; }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

std::string cameraText(const std::string& intrinsic, const std::string& depths) {
  return "extrinsic\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n\nintrinsic\n" + intrinsic + "\n\n" + depths + "\n";
}

TEST(Mvsnet, ViewsComeBackAsTheyWereWritten) {
  const TinyFolder folder;
  const DepthSet set = folder.read();
  ASSERT_EQ(set.views.size(), 2u);
  EXPECT_TRUE(set.notes.empty());
  const View view = set.views.load(1), original = tinyView(2.0);
  EXPECT_EQ(view.name, "00000001");
  EXPECT_EQ(view.projection, original.projection);
  EXPECT_TRUE(view.world_from_camera.isApprox(original.world_from_camera, 1e-14));
  EXPECT_EQ(view.map.depth, original.map.depth);
  EXPECT_EQ(view.map.confidence, original.map.confidence);
  EXPECT_EQ(view.map.color, original.map.color);
}

TEST(Mvsnet, CameraFileIsWrittenAsOthersWriteIt) {
  const TemporaryFolder folder;
  View view = tinyView(0);
  view.world_from_camera = Eigen::Translation3d(-1, -2, -3);
  MvsnetWriter(folder.path()).add(view);
  EXPECT_EQ(readText(folder / "cams/00000000_cam.txt"),
            "extrinsic\n1 0 0 1\n0 1 0 2\n0 0 1 3\n0 0 0 1\n\n"
            "intrinsic\n7.25 0 2.4\n0 7.5 1.6\n0 0 1\n\n1.25 0.006544502617801047 192 2.5\n");
}

TEST(Mvsnet, SameViewsGiveTheSameBytesAndNoOtherFile) {
  const TinyFolder a, b;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(a.path())) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_EQ(readText(entry.path()), readText(b.path() / std::filesystem::relative(entry.path(), a.path())));
  }
  EXPECT_EQ(files, 8u);
}

TEST(Mvsnet, ConfidenceAndColourAreOptional) {
  const TemporaryFolder folder;
  View view = tinyView(1);
  view.map.confidence = {};
  view.map.color = {};
  view.map.depth = Image<float>(6, 4, kInvalidDepth);
  MvsnetWriter writer(folder.path());
  writer.add(view);
  EXPECT_EQ(writer.size(), 1u);
  EXPECT_EQ(folder.entryCount(), 2u);
  const View read = readMvsnet(folder.path(), {}).views.load(0);
  EXPECT_TRUE(read.map.confidence.empty());
  EXPECT_TRUE(read.map.color.empty());
  EXPECT_EQ(read.map.depth, view.map.depth);
}

TEST(Mvsnet, PhotographsAreWrittenWithoutDepthMaps) {
  const TemporaryFolder folder;
  Photograph photograph;
  photograph.camera = {6, 4, 7, 7, 2.5, 1.5, {}};
  photograph.brightness = Image<float>(6, 4, 0.5f);
  MvsnetWriter writer(folder.path());
  writer.add(photograph);
  photograph.color = Image<Rgb8>(6, 4, Rgb8{1, 2, 3}), photograph.depth = {{1, 3}};
  writer.add(photograph);
  EXPECT_EQ(writer.size(), 2u);
  EXPECT_EQ(folder.entryCount(), 2u);
  EXPECT_EQ(readPngGrey8(folder / "images/00000000.png"), Image<std::uint8_t>(6, 4, 128));
  EXPECT_EQ(readPngRgb(folder / "images/00000001.png"), photograph.color);
  EXPECT_TRUE(readText(folder / "cams/00000000_cam.txt").ends_with("\n0 0 192 0\n"));
  EXPECT_TRUE(readText(folder / "cams/00000001_cam.txt").ends_with(" 192 3\n"));
  photograph.camera.width = 7, photograph.name = "odd";
  EXPECT_EQ(messageOf<InvalidArgument>([&] { writer.add(photograph); }),
            "photograph odd: the picture must have the size of its camera");
}

TEST(Mvsnet, WriterRefusesWhatTheLayoutCannotHold) {
  const TemporaryFolder folder;
  MvsnetWriter writer(folder.path());
  View view = tinyView(1);
  std::get<Pinhole>(view.projection).distortion[0] = 0.1;
  EXPECT_EQ(messageOf<InvalidArgument>([&] { writer.add(view); }),
            "view anything: the format mvsnet holds pinholes without distortion only");
  view.projection = Orthographic{6, 4, 0, 1, 0, 1};
  EXPECT_THROW(writer.add(view), InvalidArgument);
  view.projection = Pinhole{7, 4, 7, 7, 3, 2, {}};
  EXPECT_THROW(writer.add(view), InvalidArgument);
  EXPECT_EQ(writer.size(), 0u);
  EXPECT_FALSE(std::filesystem::exists(folder / "depth_est"));
  writeText(folder / "file", "");
  EXPECT_THROW(MvsnetWriter(folder / "file"), IoError);
}

TEST(Mvsnet, DepthsThatAreNotFiniteOrNotPositiveAreInvalid) {
  const TinyFolder folder;
  Image<float> depth(6, 4, 1.0f);
  depth(0, 0) = std::numeric_limits<float>::quiet_NaN();
  depth(1, 0) = std::numeric_limits<float>::infinity();
  depth(2, 0) = -1.0f;
  writePfm(folder / "depth_est/00000000.pfm", depth);
  const View view = folder.read().views.load(0);
  for (int x = 0; x < 3; ++x) EXPECT_EQ(view.map.depth(x, 0), kInvalidDepth);
  EXPECT_EQ(view.map.depth(3, 0), 1.0f);
}

TEST(Mvsnet, ScaleKindAndLimitsCanBeToldOtherwise) {
  const TinyFolder folder;
  ReadOptions options;
  options.depth_scale = 2.0;
  options.max_depth = 4.0;
  const View view = folder.read(options).views.load(0);
  EXPECT_EQ(view.map.depth(1, 1), 2.5f);
  EXPECT_EQ(view.map.depth(5, 3), kInvalidDepth);
  options = {};
  options.depth_kind = DepthKind::Inverse;
  EXPECT_EQ(folder.read(options).views.load(0).map.depth(5, 3), 0.4f);
}

TEST(Mvsnet, LineOfDepthsMayHoldTwoToFourNumbers) {
  const TinyFolder folder;
  const std::string intrinsic = "7 0 2.5\n0 7 1.5\n0 0 1";
  for (const char* depths : {"1 0.1", "1 0.1 192", "1 0.1 192 20"}) {
    writeText(folder.camera(), cameraText(intrinsic, depths));
    EXPECT_TRUE(
        folder.read().views.header(1).world_from_camera.translation().isApprox(Eigen::Vector3d(-1, -2, -3)));
  }
  for (const char* depths : {"1", "1 2 3 4 5"}) {
    writeText(folder.camera(), cameraText(intrinsic, depths));
    EXPECT_EQ(folder.complaint(),
              "/cams/00000001_cam.txt: line 12: expected 2 to 4 numbers (smallest depth, "
              "interval, ...), found " +
                  std::to_string(std::string(depths).size() / 2 + 1));
  }
}

TEST(Mvsnet, IntrinsicsOfThePictureAreScaledToTheDepthMap) {
  const TinyFolder folder;  // depth maps 6x4, pictures 12x8
  writeText(folder.camera(), cameraText("14 0 5.5\n0 14 3.5\n0 0 1", "1 0.1"));
  const DepthSet set = folder.read();
  EXPECT_EQ(std::get<Pinhole>(set.views.header(1).projection), (Pinhole{6, 4, 7, 7, 2.5, 1.5, {}}));
  EXPECT_EQ(set.notes,
            std::vector<std::string>{"1 camera made for images of another size, scaled to the depth map"});
}

TEST(Mvsnet, CameraIsFittedToTheDepthMapOnlyWhereItClearlyDoesNotFit) {
  const Pinhole camera{0, 0, 100, 100, 79.5, 59.5, {}};  // of a 160x120 image
  EXPECT_EQ(fitToDepthMap(camera, {160, 120}, {})->scale, 1.0);
  EXPECT_EQ(fitToDepthMap(camera, {640, 480}, {})->scale, 4.0);
  EXPECT_EQ(fitToDepthMap(camera, {40, 30}, {})->scale, 0.25);
  EXPECT_EQ(fitToDepthMap(camera, {480, 360}, 3.0)->scale, 3.0);
  EXPECT_EQ(fitToDepthMap(camera, {640, 480}, 1.0)->scale, 4.0);
  // Cropped at the right: still inside, and in the middle of the rows.
  EXPECT_EQ(fitToDepthMap(camera, {100, 120}, {})->scale, 1.0);
  EXPECT_EQ(fitToDepthMap(camera, {640, 480}, {})->pinhole, (Pinhole{640, 480, 400, 400, 319.5, 239.5, {}}));
  // A crop that no scale explains stays what it is as long as the principal point is in it.
  EXPECT_EQ(fitToDepthMap({0, 0, 100, 100, 20, 50, {}}, {160, 300}, {})->scale, 1.0);
  EXPECT_FALSE(fitToDepthMap(camera, {40, 480}, {}));
  EXPECT_FALSE(fitToDepthMap({0, 0, 100, 100, -300, -200, {}}, {160, 120}, {}));
}

TEST(Mvsnet, CameraThatFitsNoScaleIsRefused) {
  const TinyFolder folder;
  writeText(folder.camera(), cameraText("14 0 600\n0 14 -4\n0 0 1", "1 0.1"));
  EXPECT_EQ(
      folder.complaint(),
      "/cams/00000001_cam.txt: line 8: expected a principal point inside the 6x4 depth map, found 600, -4");
}

TEST(Mvsnet, BrokenCamerasAreRefusedWithTheirLine) {
  const TinyFolder folder;
  const std::string name = "/cams/00000001_cam.txt", good = readText(folder.camera());
  const auto complaintAbout = [&](const std::string& text) {
    writeText(folder.camera(), text);
    return folder.complaint();
  };
  EXPECT_EQ(complaintAbout(""), name + ": line 1: expected 'extrinsic', found the end of the file");
  EXPECT_EQ(complaintAbout("1 0 0 0\n"), name + ": line 1: expected 'extrinsic', found '1'");
  EXPECT_EQ(complaintAbout(good.substr(0, good.find("intrinsic"))),
            name + ": line 6: expected 'intrinsic', found the end of the file");
  EXPECT_EQ(
      complaintAbout("extrinsic\n1 0 0 0\n0 1 0 0\n0 0 2 0\n0 0 0 1\nintrinsic\n1 0 1\n0 1 1\n0 0 1\n1 1\n"),
      name + ": line 2: expected a rotation, found a matrix R with |RᵀR - 1| = 3");
  EXPECT_EQ(complaintAbout("extrinsic\n1 0 0 0\n0 1 0 0\n0 0 1 NaN\n"),
            name + ": line 4: expected a finite number, found 'NaN'");
  EXPECT_EQ(complaintAbout(cameraText("7 0 2.5\n0 7 1.5 0\n0 0 1", "1 1")),
            name + ": line 9: expected a 3x3 intrinsic matrix, found 4 numbers in a row");
  EXPECT_EQ(complaintAbout(cameraText("0 0 2.5\n0 7 1.5\n0 0 1", "1 1")),
            name + ": line 8: expected focal lengths above 0, found 0 and 7");
  EXPECT_EQ(
      complaintAbout(cameraText("7 0 2.5\n0 7 1.5\n0 0 1", "")),
      name + ": line 11: expected 2 to 4 numbers (smallest depth, interval, ...), found the end of the file");
  std::filesystem::remove(folder.camera());
  EXPECT_EQ(folder.complaint(),
            name + ": expected the camera of depth_est/00000001.pfm, found nothing of that name");
}

TEST(Mvsnet, BrokenImagesAreRefusedAtOnce) {
  const TinyFolder folder;
  writePfm(folder / "confidence/00000001.pfm", Image<float>(3, 2, 0.5f));
  EXPECT_EQ(folder.complaint(),
            "/confidence/00000001.pfm: expected 6x4 pixels as in the depth map, found 3x2");
  const std::filesystem::path depth = folder / "depth_est/00000001.pfm";
  writeText(depth, readText(depth).substr(0, 50));
  EXPECT_EQ(folder.complaint(),
            "/depth_est/00000001.pfm: byte 50: expected 108 bytes for 6x4 pixels, found the end of the file");
}

TEST(Mvsnet, FolderThatChangesAfterItWasOpenedIsRefused) {
  const TinyFolder folder;
  const DepthSet set = folder.read();
  writePfm(folder / "depth_est/00000001.pfm", Image<float>(3, 2, 1.0f));
  EXPECT_EQ(messageOf<IoError>([&] { set.views.load(1); }),
            (folder / "depth_est/00000001.pfm").string() + ": expected 6x4 pixels as before, found 3x2");
}

TEST(Mvsnet, FolderWithoutDepthMapsIsRefused) {
  const TinyFolder folder;
  std::filesystem::remove_all(folder / "depth_est");
  EXPECT_EQ(folder.complaint(), ": expected depth maps (depth_est/*.pfm), found none");
}

TEST(Mvsnet, WhatIsLeftOutIsNoted) {
  const TinyFolder folder;
  writeText(folder / "cams/00000007_cam.txt", readText(folder.camera()));
  std::filesystem::remove(folder / "confidence/00000000.pfm");
  EXPECT_EQ(folder.read().notes,
            (std::vector<std::string>{"1 camera without a depth map left out", "1 view without confidence"}));
}

}  // namespace
}  // namespace vdbfuse
