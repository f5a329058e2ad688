// SPDX-License-Identifier: Apache-2.0
#include "formats/rgbd_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;

constexpr const char* kIdentity = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";

// Two frames of 4x3 pixels: everything at 1.5 m, pixel (0, 0) empty and (1, 0) saturated. The second camera
// looks along +x from (1, 2, 3). Only the first has colour.
struct TinyFolder : TemporaryFolder {
  TinyFolder() {
    Image<std::uint16_t> depth(4, 3, std::uint16_t{1500});
    depth(0, 0) = 0, depth(1, 0) = 65535;
    writePng(*this / "b.depth.png", depth);
    writePng(*this / "a.depth.png", depth);
    writePng(*this / "a.color.png", Image<Rgb8>(4, 3, Rgb8{1, 2, 3}));
    writeText(*this / "a.pose.txt", kIdentity);
    writeText(*this / "b.pose.txt", "0 0 1 1\n0 1 0 2\n-1 0 0 3\n");
    writeText(*this / "camera-intrinsics.txt", "4 0 1.5\n0 5 1\n0 0 1\n");
  }
  DepthSet read(const ReadOptions& options = {}) const { return readRgbdFolder(path(), options); }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

TEST(RgbdFolder, FramesAreReadInTheOrderOfTheirNames) {
  const TinyFolder folder;
  const DepthSet set = folder.read();
  ASSERT_EQ(set.views.size(), 2u);
  EXPECT_EQ(set.views.header(0).name, "a");
  EXPECT_EQ(set.views.header(1).name, "b");
  EXPECT_EQ(set.notes, std::vector<std::string>{"colour for 1 of 2 views"});
}

TEST(RgbdFolder, DepthIsInMetresWithOneKindOfInvalid) {
  const TinyFolder folder;
  const View view = folder.read().views.load(0);
  EXPECT_EQ(view.map.depth(0, 0), kInvalidDepth);
  EXPECT_EQ(view.map.depth(1, 0), kInvalidDepth);
  EXPECT_FLOAT_EQ(view.map.depth(2, 0), 1.5f);
  EXPECT_TRUE(view.map.confidence.empty());
}

TEST(RgbdFolder, CameraAndPoseAreThoseOfTheFiles) {
  const TinyFolder folder;
  const DepthSet set = folder.read();
  EXPECT_EQ(std::get<Pinhole>(set.views.header(1).projection), (Pinhole{4, 3, 4, 5, 1.5, 1, {}}));
  EXPECT_TRUE(set.views.header(0).world_from_camera.isApprox(RigidTransform::Identity()));
  // One metre in front of the second camera.
  const Eigen::Vector3d ahead = set.views.header(1).world_from_camera * Eigen::Vector3d(0, 0, 1);
  EXPECT_TRUE(ahead.isApprox(Eigen::Vector3d(2, 2, 3)));
}

TEST(RgbdFolder, RotationsThatAreOrthonormalToAThousandthAreMadeExact) {
  const TinyFolder folder;
  writeText(folder / "a.pose.txt", "1.001 0 0 0\n0.0005 1 0 0\n0 0 0.999 0\n0 0 0 1\n");
  EXPECT_LT(rotationError(folder.read().views.header(0).world_from_camera.linear()), 1e-12);
}

TEST(RgbdFolder, ColourIsLoadedWhereThereIsOneAndAskedFor) {
  const TinyFolder folder;
  EXPECT_EQ(folder.read().views.load(0).map.color(3, 2), (Rgb8{1, 2, 3}));
  EXPECT_TRUE(folder.read().views.load(1).map.color.empty());
  ReadOptions options;
  options.color = ReadOptions::Color::Skip;
  EXPECT_TRUE(folder.read(options).views.load(0).map.color.empty());
}

TEST(RgbdFolder, ScaleKindAndLimitsCanBeToldOtherwise) {
  const TinyFolder folder;
  ReadOptions options;
  options.depth_scale = 0.01;
  EXPECT_FLOAT_EQ(folder.read(options).views.load(0).map.depth(2, 1), 15.0f);
  options.max_depth = 14.0;
  EXPECT_EQ(folder.read(options).views.load(0).map.depth(2, 1), kInvalidDepth);
  options = {};
  options.depth_kind = DepthKind::Range;
  // The ray of pixel (3, 2) is (1.5/4, 1/5, 1).
  const double expected = 1.5 / std::hypot(1.5 / 4, 1.0 / 5, 1.0);
  EXPECT_NEAR(folder.read(options).views.load(0).map.depth(3, 2), expected, 1e-6);
  options = {};
  options.depth_kind = DepthKind::Disparity;
  options.baseline = 0.5;
  EXPECT_FLOAT_EQ(folder.read(options).views.load(0).map.depth(2, 1), 4.0f * 0.5f / 1500.0f);
  options.depth_kind = DepthKind::Inverse;
  options.depth_scale = 0.001;
  EXPECT_FLOAT_EQ(folder.read(options).views.load(0).map.depth(2, 1), 1.0f / 1.5f);
}

TEST(RgbdFolder, DepthMapsOfDifferentSizesHaveCamerasOfTheirOwn) {
  const TinyFolder folder;
  writePng(folder / "b.depth.png", Image<std::uint16_t>(8, 6, std::uint16_t{700}));
  const DepthSet set = folder.read();
  EXPECT_EQ(imageWidth(set.views.header(0).projection), 4);
  EXPECT_EQ(set.views.load(1).map.depth.width(), 8);
}

TEST(RgbdFolder, MissingPoseIsNamed) {
  const TinyFolder folder;
  std::filesystem::remove(folder / "b.pose.txt");
  EXPECT_EQ(folder.complaint(), "/b.pose.txt: expected the pose of b.depth.png, found nothing of that name");
}

TEST(RgbdFolder, PoseThatIsNotARotationIsRefused) {
  const TinyFolder folder;
  writeText(folder / "b.pose.txt", "\n1 0 0 0\n0 1.1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(folder.complaint(),
            "/b.pose.txt: line 2: expected a rotation, found a matrix R with |RᵀR - 1| = 0.21");
  writeText(folder / "b.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n");
  EXPECT_EQ(folder.complaint(),
            "/b.pose.txt: line 1: expected a rotation, found a matrix with determinant -1");
  writeText(folder / "b.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n5 0 0 1\n");
  EXPECT_EQ(folder.complaint(),
            "/b.pose.txt: line 1: expected a pose whose last row is 0 0 0 1, found 5 0 0 1");
}

TEST(RgbdFolder, PoseThatIsNotFiniteIsRefusedWithItsLine) {
  const TinyFolder folder;
  writeText(folder / "b.pose.txt", "1 0 0 0\n0 1 0 nan\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(folder.complaint(), "/b.pose.txt: line 2: expected a finite number, found 'nan'");
  writeText(folder / "b.pose.txt", "-inf -inf -inf -inf\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(folder.complaint(), "/b.pose.txt: line 1: expected a finite number, found '-inf'");
}

TEST(RgbdFolder, ShortPoseIsRefusedWithItsLine) {
  const TinyFolder folder;
  writeText(folder / "b.pose.txt", "1 0 0 0\n0 1 0 0\n");
  EXPECT_EQ(folder.complaint(),
            "/b.pose.txt: line 3: expected a 4x4 or 3x4 pose matrix, found the end of the file");
  writeText(folder / "b.pose.txt", "1 0 0 0\n0 1 0\n0 0 1 0\n0 0 0 1\n");
  EXPECT_EQ(folder.complaint(),
            "/b.pose.txt: line 2: expected a 4x4 or 3x4 pose matrix, found 3 numbers in a row");
  writeText(folder / "b.pose.txt", "");
  EXPECT_EQ(folder.complaint(),
            "/b.pose.txt: line 1: expected a 4x4 or 3x4 pose matrix, found the end of the file");
}

TEST(RgbdFolder, BrokenIntrinsicsAreRefusedWithTheirLine) {
  const TinyFolder folder;
  const std::filesystem::path file = folder / "camera-intrinsics.txt";
  const std::string name = "/camera-intrinsics.txt";
  writeText(file, "4 0 1.5\n0 5 1\n");
  EXPECT_EQ(folder.complaint(),
            name + ": line 3: expected a 3x3 matrix of intrinsics, found the end of the file");
  writeText(file, "4 0 1.5\n0 nan 1\n0 0 1\n");
  EXPECT_EQ(folder.complaint(), name + ": line 2: expected a finite number, found 'nan'");
  writeText(file, "4 0 1.5\n0 -5 1\n0 0 1\n");
  EXPECT_EQ(folder.complaint(), name + ": line 1: expected focal lengths above 0, found 4 and -5");
  writeText(file, "4 3 1.5\n0 5 1\n0 0 1\n");
  EXPECT_EQ(folder.complaint(),
            name + ": line 1: expected intrinsics without skew, found 3 and 0 beside the focal lengths");
  writeText(file, "4 0 1.5\n0 5 1\n0 0 2\n");
  EXPECT_EQ(folder.complaint(), name + ": line 1: expected intrinsics whose last row is 0 0 1, found 0 0 2");
  writeText(file, "4 0 1.5\n0 5 one\n0 0 1\n");
  EXPECT_EQ(folder.complaint(), name + ": line 2: expected a finite number, found 'one'");
  std::filesystem::remove(file);
  EXPECT_EQ(folder.complaint(),
            ": expected an intrinsics file (*intrinsics*.txt), or --intrinsics, found none");
  writeText(folder / "x.intrinsics.txt", "");
  writeText(folder / "intrinsics.txt", "");
  EXPECT_EQ(folder.complaint(),
            ": expected one intrinsics file (*intrinsics*.txt), found intrinsics.txt and x.intrinsics.txt");
}

TEST(RgbdFolder, BrokenImagesAreRefusedWhenTheyAreLoaded) {
  const TinyFolder folder;
  const std::string good = readText(folder / "b.depth.png");
  writeText(folder / "b.depth.png", good.substr(0, 50));
  const DepthSet set = folder.read();
  EXPECT_EQ(messageOf<IoError>([&] { set.views.load(1); }),
            (folder / "b.depth.png").string() +
                ": byte 50: expected pixels of a 4x3 16-bit grey image, found the end of the file");
  EXPECT_NO_THROW(set.views.load(0));
  writePng(folder / "b.depth.png", Image<std::uint16_t>(3, 3, std::uint16_t{5}));
  EXPECT_EQ(messageOf<IoError>([&] { set.views.load(1); }),
            (folder / "b.depth.png").string() + ": expected 4x3 pixels as before, found 3x3");
  writePng(folder / "b.depth.png", Image<std::uint8_t>(4, 3, std::uint8_t{5}));
  EXPECT_EQ(messageOf<IoError>([&] { set.views.load(1); }),
            (folder / "b.depth.png").string() + ": expected depths of 16 bits or more, found 8-bit PNG");
}

TEST(RgbdFolder, FolderWithoutDepthMapsIsRefused) {
  const TinyFolder folder;
  std::filesystem::remove(folder / "a.depth.png");
  std::filesystem::remove(folder / "b.depth.png");
  EXPECT_EQ(folder.complaint(), ": expected depth maps (*.depth.png), found none");
}

TEST(RgbdFolder, IntrinsicsCanBeGivenInPlaceOfAFile) {
  const TinyFolder folder;
  std::filesystem::remove(folder / "camera-intrinsics.txt");
  ReadOptions options;
  options.intrinsics = {{5, 6, 1, 2}};
  EXPECT_EQ(std::get<Pinhole>(folder.read(options).views.header(0).projection),
            (Pinhole{4, 3, 5, 6, 1, 2, {}}));
}

TEST(RgbdFolder, OddThingsAreNoted) {
  const TinyFolder folder;
  writeText(folder / "c.pose.txt", kIdentity);
  writeText(folder / "camera-intrinsics.txt", "4 0 320\n0 5 240\n0 0 1\n");
  EXPECT_EQ(folder.read().notes,
            (std::vector<std::string>{"colour for 1 of 2 views",
                                      "the principal point lies outside the 4x3 depth map of view a",
                                      "1 pose without a depth map left out"}));
}

}  // namespace
}  // namespace vdbfuse
