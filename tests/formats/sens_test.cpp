// SPDX-License-Identifier: Apache-2.0
#include "formats/sens.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

#include "formats/sens_sample.h"
#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::sensBytes;
using test::SensRecording;
using test::TemporaryFolder;
using test::tinyRecording;
using test::writeText;

// Where the parts of a file begin that sensBytes() writes.
constexpr std::size_t kColorIntrinsics = 18, kDepthIntrinsics = kColorIntrinsics + 128,
                      kCompressions = kDepthIntrinsics + 128, kSizes = kCompressions + 8,
                      kShift = kSizes + 16, kCount = kShift + 4, kFrame = kCount + 8,
                      kColorSize = kFrame + 80, kData = kFrame + 96;

struct File : TemporaryFolder {
  explicit File(const SensRecording& recording) : File(sensBytes(recording)) {}
  explicit File(const std::string& bytes) { writeText(*this / "a.sens", bytes); }
  DepthSet read(const ReadOptions& options = {}) const { return readSens(*this / "a.sens", options); }
  std::string complaint() const {
    return shortened(messageOf<IoError>([&] { read(); }));
  }
  std::string complaintOfView() const {
    const DepthSet set = read();
    return shortened(messageOf<IoError>([&] { set.views.load(0); }));
  }

 private:
  std::string shortened(const std::string& message) const {
    const std::string path = (*this / "a.sens").string();
    return message.starts_with(path) ? message.substr(path.size()) : message;
  }
};

template <class Number>
std::string with(std::string bytes, std::size_t at, Number value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
  return bytes;
}

TEST(Sens, FramesAreReadWithTheirPosesForEveryCompression) {
  for (const int depth : {0, 1}) {
    for (const int color : {0, 1, 2}) {
      const File file(tinyRecording(color, depth));
      const DepthSet set = file.read();
      test::expectSameViews(set.views, test::tinyViews(), 0.00051);
      EXPECT_EQ(set.views.header(2).name, "frame-000002");
      EXPECT_FALSE(set.views.header(0).color_sensor);
      EXPECT_TRUE(set.notes.empty());
      const Image<Rgb8> found = set.views.load(1).map.color, truth = test::tinyViews()[1].map.color;
      ASSERT_TRUE(found.sameSize(truth));
      for (std::size_t i = 0; i < truth.size(); ++i)
        EXPECT_NEAR(found.data()[i][1], truth.data()[i][1], color == 2 ? 6 : 0);
    }
  }
}

TEST(Sens, ReadingSaysWhatWasTakenForGranted) {
  const File file(tinyRecording(2, 1));
  const DepthReading reading = file.read().reading;
  EXPECT_EQ(reading.stored, "16-bit numbers, zlib");
  EXPECT_EQ(reading.kind, DepthKind::Z);
  EXPECT_DOUBLE_EQ(reading.scale, 0.001);
}

TEST(Sens, OptionsAreObeyed) {
  const File file(tinyRecording(2, 1));
  ReadOptions options;
  options.depth_scale = 0.01;
  options.max_depth = 20;
  options.intrinsics = {{10, 11, 3, 4}};
  options.color = ReadOptions::Color::Skip;
  const View view = file.read(options).views.load(0), plain = file.read().views.load(0);
  EXPECT_NEAR(view.map.depth(12, 9), 10 * plain.map.depth(12, 9), 1e-4);
  EXPECT_EQ(*std::max_element(view.map.depth.begin(), view.map.depth.end()) <= 20, true);
  EXPECT_EQ(std::get<Pinhole>(view.projection), (Pinhole{24, 18, 10, 11, 3, 4, {}}));
  EXPECT_TRUE(view.map.color.empty());
}

TEST(Sens, FramesWithoutAPoseAreLeftOut) {
  const float lost = -std::numeric_limits<float>::infinity();
  const File file(with(sensBytes(tinyRecording(0, 0)), kFrame, lost));
  const DepthSet set = file.read();
  ASSERT_EQ(set.views.size(), 2U);
  EXPECT_EQ(set.views.header(0).name, "frame-000001");
  EXPECT_NEAR(set.views.load(0).map.depth(12, 9), test::tinyViews()[1].map.depth(12, 9), 0.00051);
  EXPECT_THAT(set.notes, testing::ElementsAre("1 frame without a pose left out"));
  SensRecording one = tinyRecording(0, 0);
  one.views.resize(1);
  EXPECT_EQ(File(with(sensBytes(one), kFrame, lost)).complaint(),
            ": expected a frame with a pose, found 1 frame without");
}

TEST(Sens, ColourCameraOfItsOwnIsPlacedByTheExtrinsics) {
  SensRecording recording = tinyRecording(1, 1);
  recording.color_intrinsics(0, 0) = 30;
  recording.color_extrinsics(0, 3) = 0.25F;  // x_color = x_rig + 0.25
  recording.depth_extrinsics(1, 3) = 0.5F;
  const File file(recording);
  const DepthSet set = file.read();
  const auto& sensor = set.views.header(0).color_sensor;
  ASSERT_TRUE(sensor);
  EXPECT_EQ(std::get<Pinhole>(sensor->projection), (Pinhole{24, 18, 30, 23.25, 11.75, 8.5, {}}));
  // The colour camera's centre is at rig (-0.25, 0, 0), which is depth (-0.25, 0.5, 0).
  const Eigen::Vector3d centre = set.views.header(0).world_from_camera * Eigen::Vector3d(-0.25, 0.5, 0);
  EXPECT_TRUE(sensor->world_from_camera.translation().isApprox(centre, 1e-6));
}

TEST(Sens, PicturesThatCannotBePlacedAreLeftOut) {
  SensRecording recording = tinyRecording(1, 1);
  recording.color_intrinsics.setZero();
  const File file(recording);
  const DepthSet set = file.read();
  EXPECT_THAT(set.notes, testing::ElementsAre("pictures left out: their camera or coding is not known"));
  EXPECT_TRUE(set.views.load(0).map.color.empty());
}

TEST(Sens, AFolderMayHoldOneFile) {
  const File file(tinyRecording(0, 0));
  EXPECT_EQ(readDepthSet(file.path()).format, "sens");
  writeText(file / "b.sens", "");
  EXPECT_EQ(messageOf<IoError>([&] { readSens(file.path(), {}); }),
            file.path().string() + ": expected one .sens file, found a.sens and b.sens");
  const TemporaryFolder empty;
  EXPECT_EQ(messageOf<IoError>([&] { readSens(empty.path(), {}); }),
            empty.path().string() + ": expected a .sens file, found none");
}

TEST(Sens, BrokenHeadersAreRefusedWithTheirByte) {
  const std::string good = sensBytes(tinyRecording(0, 0));
  const auto complaintAbout = [&](std::size_t at, auto value) {
    return File(with(good, at, value)).complaint();
  };
  EXPECT_EQ(complaintAbout(0, 3), ": byte 0: expected version 4 of .sens, found 3");
  EXPECT_EQ(complaintAbout(4, std::uint64_t{5000}),
            ": byte 4: expected a name of at most 4096 bytes, found 5000");
  EXPECT_EQ(complaintAbout(kDepthIntrinsics, -1.0F),
            ": byte 146: expected focal lengths above 0, found -1 and 23.25");
  EXPECT_EQ(complaintAbout(kDepthIntrinsics + 8, std::numeric_limits<float>::quiet_NaN()),
            ": byte 146: expected finite intrinsics, found others");
  EXPECT_EQ(complaintAbout(kCompressions + 4, 2),
            ": byte 278: expected depth that is raw (0) or zlib (1), found occi (2)");
  EXPECT_EQ(complaintAbout(kCompressions + 4, -1),
            ": byte 278: expected depth that is raw (0) or zlib (1), found -1");
  EXPECT_EQ(complaintAbout(kSizes + 8, 0),
            ": byte 290: expected an image of 1 to 268435456 pixels, found 0x18");
  EXPECT_EQ(complaintAbout(kShift, 0.0F), ": byte 298: expected a depth shift above 0, found 0");
  EXPECT_EQ(complaintAbout(kCount, std::uint64_t{1} << 60),
            ": byte 302: expected no more frames than the file has room for, found 1152921504606846976");
  EXPECT_EQ(complaintAbout(kFrame, 2.0F),
            ": byte 310: expected a rotation, found a matrix R with |RᵀR - 1| = 3.14977");
  EXPECT_EQ(complaintAbout(kColorSize + 8, ~std::uint64_t{0}),
            ": byte 1702: expected a depth map of 18446744073709551615 bytes, found the end of the file");
  EXPECT_EQ(File(good.substr(0, 200)).complaint(),
            ": byte 146: expected intrinsics of the depth camera of 64 bytes, found the end of the file");
}

TEST(Sens, BrokenImagesAreRefusedWhenTheyAreLoaded) {
  EXPECT_EQ(File(with(sensBytes(tinyRecording(0, 0)), kSizes + 8, 25)).complaintOfView(),
            ": byte 398: expected raw depth of 900 bytes, found 864");
  EXPECT_EQ(File(with(sensBytes(tinyRecording(0, 0)), kSizes, 25)).complaintOfView(),
            ": byte 406: expected a raw picture of 1350 bytes, found 1296");
  SensRecording packed = tinyRecording(0, 1);
  packed.views[0].map.color = {};
  packed.views[1].map.color = {};
  std::swap(packed.views[0], packed.views[2]);
  const std::string good = sensBytes(packed);
  const std::size_t depth = kData + 1296;
  EXPECT_EQ(File(with(good, depth + 2, 'x')).complaintOfView(),
            ": byte 1702: expected 864 bytes of depth packed by zlib, found damaged data");
  EXPECT_EQ(File(with(good, kSizes + 8, 25)).complaintOfView(),
            ": byte 1702: expected 900 bytes of depth packed by zlib, found another number of them");
  EXPECT_EQ(File(with(good, kSizes + 8, 23)).complaintOfView(),
            ": byte 1702: expected 828 bytes of depth packed by zlib, found another number of them");
  EXPECT_THAT(File(with(good, kSizes + 8, 10000000)).complaintOfView(),
              testing::StartsWith(": byte 1702: expected 360000000 bytes of depth packed by zlib, found "));
  EXPECT_EQ(File(with(sensBytes(tinyRecording(1, 0)), kSizes, 25)).complaintOfView(),
            ": byte 406: expected a picture of 25x18 pixels, found 24x18");
  EXPECT_THAT(File(with(sensBytes(tinyRecording(2, 0)), kData, 0)).complaintOfView(),
              testing::StartsWith(": byte 406: expected a JPEG file, found "));
}

}  // namespace
}  // namespace vdbfuse
