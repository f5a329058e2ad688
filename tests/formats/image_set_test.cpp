// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/formats/image_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "formats/image_samples.h"
#include "io/shared_data.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using test::messageOf;
using test::Sample;
using test::TemporaryFolder;
using test::tinyPhotographs;
using test::writeText;

PhotographSequence tinySequence() { return PhotographSequence::fromPhotographs(tinyPhotographs()); }

void expectSamePhotographs(const PhotographSequence& found, const std::vector<Photograph>& truth) {
  ASSERT_EQ(found.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Photograph photograph = found.load(i);
    EXPECT_EQ(photograph.name, truth[i].name);
    const Pinhole &camera = photograph.camera, &expected = truth[i].camera;
    EXPECT_EQ(camera.width, expected.width);
    EXPECT_EQ(camera.height, expected.height);
    EXPECT_NEAR(camera.fx, expected.fx, 1e-6);
    EXPECT_NEAR(camera.fy, expected.fy, 1e-6);
    EXPECT_NEAR(camera.cx, expected.cx, 1e-6);
    EXPECT_NEAR(camera.cy, expected.cy, 1e-6);
    EXPECT_TRUE(photograph.world_from_camera.isApprox(truth[i].world_from_camera, 1e-6));
    EXPECT_EQ(photograph.brightness, truth[i].brightness);
    EXPECT_EQ(photograph.color, truth[i].color);
    EXPECT_EQ(photograph.mask, truth[i].mask);
  }
}

struct Writing {
  std::string format;
  ImageWriteOptions options;
};

std::vector<Writing> writings() {
  std::vector<Writing> all;
  for (const ImageSetFormat& format : imageSetFormats()) all.push_back({std::string(format.name), {}});
  all.push_back({"colmap", {ImageWriteOptions::Encoding::Binary}});
  return all;
}

class ImageRoundTrip : public testing::TestWithParam<Writing> {};

TEST_P(ImageRoundTrip, GivesCamerasPosesAndPicturesBack) {
  const TemporaryFolder folder;
  writeImageSet(folder / "set", GetParam().format, tinySequence(), GetParam().options);
  const ImageSet set = readImageSet(folder / "set");
  EXPECT_EQ(set.format, GetParam().format);
  EXPECT_FALSE(set.pose.empty());
  EXPECT_EQ(set.notes, std::vector<std::string>{"silhouette masks for 1 of 4 photographs"});
  expectSamePhotographs(set.photographs, tinyPhotographs());
}

TEST_P(ImageRoundTrip, KeepsDepthsWhereTheFormatHoldsThem) {
  const TemporaryFolder folder;
  writeImageSet(folder / "set", GetParam().format, tinySequence(), GetParam().options);
  const auto depth = readImageSet(folder / "set").photographs.header(3).depth;
  ASSERT_EQ(depth.has_value(), GetParam().format == "mvsnet");
  if (!depth) return;
  EXPECT_NEAR(depth->near, 1.4, 1e-9);
  EXPECT_NEAR(depth->far, 3, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Formats, ImageRoundTrip, testing::ValuesIn(writings()), [](const auto& test) {
  return test.param.format + std::string(test.index < imageSetFormats().size() ? "" : "_binary");
});

class ImageSamples : public testing::TestWithParam<Sample> {};

TEST_P(ImageSamples, AreFoundOutByLooking) {
  const TemporaryFolder folder;
  GetParam().write(folder.path());
  EXPECT_TRUE(isImageSet(folder / GetParam().input));
  EXPECT_EQ(readImageSet(folder / GetParam().input).format, GetParam().format);
}

TEST_P(ImageSamples, HaveThePosesOfTheScene) {
  const TemporaryFolder folder;
  GetParam().write(folder.path());
  const PhotographSequence photographs = readImageSet(folder / GetParam().input).photographs;
  ASSERT_GE(photographs.size(), 3u);
  // All cameras look at the origin from a distance of 2.
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    const PhotographHeader& header = photographs.header(i);
    const auto pixel = project(header.camera, header.world_from_camera.inverse() * Eigen::Vector3d::Zero());
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->depth, 2, 1e-6);
    EXPECT_NEAR(pixel->x, header.camera.cx, 1e-6);
    EXPECT_NEAR(pixel->y, header.camera.cy, 1e-6);
    photographs.load(i);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, ImageSamples, testing::ValuesIn(test::imageSamples()),
                         [](const auto& test) { return test.param.format + "_" + test.param.variant; });

TEST(ImageSets, EveryFormatHasASample) {
  std::set<std::string_view> formats, samples;
  for (const ImageSetFormat& format : imageSetFormats()) formats.insert(format.name);
  for (const Sample& sample : test::imageSamples()) samples.insert(sample.format);
  EXPECT_EQ(formats, samples);
}

TEST(ImageSets, SparsePointsSayWhereDepthsLie) {
  for (const auto write : {test::writeBundlerSample, test::writeNvmSample, test::writeColmapPointsSample}) {
    const TemporaryFolder folder;
    write(folder.path());
    const ImageSet set = readImageSet(folder.path());
    ASSERT_EQ(set.photographs.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const PhotographHeader& header = set.photographs.header(i);
      ASSERT_TRUE(header.depth.has_value());
      double nearest = 100, furthest = 0;
      for (const Eigen::Vector3d& point : test::tinyPoints()) {
        const double depth = (header.world_from_camera.inverse() * point).z();
        nearest = std::min(nearest, depth), furthest = std::max(furthest, depth);
      }
      EXPECT_NEAR(header.depth->near, nearest - 0.1 * (furthest - nearest), 1e-5);
      EXPECT_NEAR(header.depth->far, furthest + 0.1 * (furthest - nearest), 1e-5);
    }
  }
}

TEST(ImageSets, DistortionIsTakenOutAndSaid) {
  for (const auto write : {test::writeBundlerSample, test::writeNvmSample, test::writeColmapPointsSample}) {
    const TemporaryFolder folder;
    write(folder.path());
    const ImageSet set = readImageSet(folder.path());
    EXPECT_THAT(set.notes, testing::Contains("lens distortion taken out of 4 of 4 photographs"));
    EXPECT_EQ(set.photographs.header(0).camera.fx, 22.5);
    EXPECT_EQ(set.photographs.header(0).camera.cx, 11.5);
    // In the middle, where there is none, the picture is as it was.
    const Photograph found = set.photographs.load(0), truth = tinyPhotographs()[0];
    EXPECT_NEAR(found.brightness(12, 9), truth.brightness(12, 9), 1e-3);
    EXPECT_GT(std::abs(found.brightness(2, 2) - truth.brightness(2, 2)), 1e-3);
  }
}

TEST(ImageSets, MasksComeFromAFolderTheSetOrTheAlphaChannel) {
  const TemporaryFolder folder;
  writeImageSet(folder / "set", "strecha", tinySequence());
  fs::create_directories(folder / "other");
  ImageReadOptions options;
  options.masks = folder / "other";
  EXPECT_EQ(messageOf<IoError>([&] { readImageSet(folder / "set", options); }),
            (folder / "other/0.png").string() + ": expected the mask of view 0, found nothing of that name");
  for (const char* name : {"0", "1", "2", "3"})
    writePng(folder / "other" / (std::string(name) + ".png"), Image<std::uint8_t>(24, 18, std::uint8_t{1}));
  const ImageSet set = readImageSet(folder / "set", options);
  EXPECT_EQ(set.notes, std::vector<std::string>{"silhouette masks for 4 of 4 photographs"});
  EXPECT_EQ(set.photographs.load(1).mask, Image<std::uint8_t>(24, 18, std::uint8_t{255}));
  writePng(folder / "set/masks/1.png", Image<std::uint8_t>(18, 24));
  EXPECT_EQ(messageOf<IoError>([&] { readImageSet(folder / "set"); }),
            (folder / "set/masks/1.png").string() +
                ": expected a mask of 24x18 pixels as the picture, found 18x24");
}

TEST(ImageSets, PhotographsWhosePictureIsMissingAreLeftOut) {
  const TemporaryFolder folder;
  writeImageSet(folder / "set", "middlebury", tinySequence());
  fs::remove(folder / "set/2.png");
  const ImageSet set = readImageSet(folder / "set");
  EXPECT_EQ(set.photographs.size(), 3u);
  EXPECT_THAT(set.notes, testing::Contains("1 photograph whose picture is missing left out"));
  for (const char* name : {"0", "1", "3"}) fs::remove(folder / "set" / (std::string(name) + ".png"));
  EXPECT_EQ(messageOf<IoError>([&] { readImageSet(folder / "set"); }),
            (folder / "set/0.png").string() + ": expected a picture, found nothing of that name");
}

TEST(ImageSets, CamerasAreScaledToTheirPictures) {
  const TemporaryFolder folder;
  writeImageSet(folder / "set", "colmap", tinySequence());
  for (const char* name : {"0", "1", "2", "3"})
    writePng(folder / "set/images" / (std::string(name) + ".png"), Image<Rgb8>(48, 36, Rgb8{1, 2, 3}));
  fs::remove_all(folder / "set/masks");
  const ImageSet set = readImageSet(folder / "set");
  EXPECT_EQ(set.notes,
            std::vector<std::string>{"4 cameras made for pictures of another size, scaled to the picture"});
  EXPECT_EQ(set.photographs.header(0).camera, (Pinhole{48, 36, 45, 45, 23.5, 17.5, {}}));
  writePng(folder / "set/images/3.png", Image<Rgb8>(36, 48, Rgb8{1, 2, 3}));
  EXPECT_EQ(messageOf<IoError>([&] { readImageSet(folder / "set"); }),
            (folder / "set/images/3.png").string() +
                ": expected a picture of the shape of its camera, 24x18, found 36x48");
}

TEST(ImageSets, CamerasOfMvsnetMayBeOfAQuarterOfTheSize) {
  const TemporaryFolder folder;
  writeImageSet(folder / "set", "mvsnet", tinySequence());
  writePng(folder / "set/images/0.png", Image<Rgb8>(96, 72, Rgb8{1, 2, 3}));
  fs::remove(folder / "set/images/2.png");
  const ImageSet set = readImageSet(folder / "set");
  EXPECT_EQ(set.notes, (std::vector<std::string>{
                           "silhouette masks for 1 of 3 photographs", "1 camera without a picture left out",
                           "1 camera made for images of another size, scaled to the picture"}));
  EXPECT_EQ(set.photographs.header(0).camera, (Pinhole{96, 72, 90, 90, 47.5, 35.5, {}}));
  // Two numbers: 192 depths from the smallest on.
  const std::string camera = test::readText(folder / "set/cams/1_cam.txt");
  writeText(folder / "set/cams/1_cam.txt", camera.substr(0, camera.rfind("\n1.4")) + "\n2 0.5\n");
  EXPECT_NEAR(readImageSet(folder / "set").photographs.header(1).depth->far, 2 + 0.5 * 191, 1e-9);
}

TEST(ImageSets, MasksOfTransformsAreThoseTheyName) {
  const TemporaryFolder folder;
  writePng(folder / "a.png", Image<Rgb8>(4, 3, Rgb8{1, 2, 3}));
  Image<std::uint8_t> mask(4, 3, std::uint8_t{9});
  mask(1, 2) = 0;
  writePng(folder / "m.png", mask);
  const auto write = [&](const std::string& frame) {
    writeText(
        folder / "transforms.json",
        R"({"fl_x": 4, "frames": [{"file_path": "a", "transform_matrix": [[1,0,0,5],[0,1,0,0],[0,0,1,0]])" +
            frame + "}]}");
  };
  write(R"(, "mask_path": "m.png")");
  const ImageSet set = readImageSet(folder.path());
  const Photograph photograph = set.photographs.load(0);
  EXPECT_EQ(photograph.camera, (Pinhole{4, 3, 4, 4, 1.5, 1, {}}));
  EXPECT_EQ(photograph.mask(1, 2), 0);
  EXPECT_EQ(photograph.mask(2, 2), 255);
  // Looks along -z.
  EXPECT_TRUE((photograph.world_from_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(5, 0, -1)));
  write(R"(, "mask_path": "../m.png")");
  EXPECT_EQ(messageOf<IoError>([&] { readImageSet(folder.path()); }),
            (folder / "transforms.json").string() +
                ": frames[0].mask_path: expected a path inside the data set, found '../m.png'");
}

TEST(ImageSets, OfNoKnownFormatSayWhatLiesThere) {
  const TemporaryFolder folder;
  writeText(folder / "b", "x");
  EXPECT_FALSE(isImageSet(folder.path()));
  EXPECT_EQ(messageOf<IoError>([&] { readImageSet(folder.path()); }),
            folder.path().string() +
                ": expected a set of photographs of a known format (vdbfuse formats PATH "
                "says what each lacks), found a folder of b");
  EXPECT_EQ(messageOf<IoError>([&] { readImageSet(folder / "none"); }),
            (folder / "none").string() + ": expected a set of photographs, found nothing of that name");
  EXPECT_THAT(messageOf<InvalidArgument>([&] {
                readImageSet(folder.path(), {"vrml", {}});
              }),
              testing::AllOf(testing::StartsWith("format: expected one of middlebury, "),
                             testing::EndsWith(", found 'vrml'")));
}

TEST(ImageSets, WriterRefusesWhatAFormatCannotHold) {
  const TemporaryFolder folder;
  std::vector<Photograph> photographs = tinyPhotographs();
  photographs[1].camera.fy *= 1.01;
  photographs[2].camera.cx += 1;
  for (const char* format : {"bundler", "nvm"}) {
    for (const std::size_t i : {1u, 2u}) {
      EXPECT_EQ(messageOf<InvalidArgument>([&] {
                  writeImageSet(folder / "set", format,
                                PhotographSequence::fromPhotographs({photographs[i]}));
                }),
                "photograph " + std::to_string(i) + ": the format " + format +
                    " holds one focal length and a principal point in the middle only");
    }
  }
  EXPECT_EQ(messageOf<InvalidArgument>([&] { writeImageSet(folder / "set", "colmap", {}); }),
            "photographs: expected at least one photograph, found none");
}

TEST(ImageSets, TheTempleIsSeenInEveryPhotograph) {
  const auto folder = test::sharedData("temple-sparse-ring");
  if (!folder) GTEST_SKIP() << "temple-sparse-ring is not there";
  const ImageSet set = readImageSet(*folder);
  EXPECT_EQ(set.format, "middlebury");
  EXPECT_TRUE(set.notes.empty());
  ASSERT_EQ(set.photographs.size(), 16u);
  // The middle of the box that its README.txt states.
  const Eigen::Vector3d middle(-0.0223565, 0.10181, 0.0251455);
  for (std::size_t i = 0; i < 16; ++i) {
    const Photograph photograph = set.photographs.load(i);
    EXPECT_EQ(photograph.brightness.width(), 640);
    EXPECT_EQ(photograph.brightness.height(), 480);
    const auto pixel = project(photograph.camera, photograph.world_from_camera.inverse() * middle);
    ASSERT_TRUE(pixel.has_value());
    const int x = nearestPixel(pixel->x), y = nearestPixel(pixel->y);
    ASSERT_TRUE(photograph.brightness.contains(x - 40, y - 40) &&
                photograph.brightness.contains(x + 40, y + 40));
    // The temple is bright before a black background.
    double sum = 0;
    for (int v = y - 40; v <= y + 40; ++v)
      for (int u = x - 40; u <= x + 40; ++u) sum += photograph.brightness(u, v);
    EXPECT_GT(sum / (81 * 81), 0.1) << i;
    EXPECT_GT(pixel->depth, 0.5);
    EXPECT_LT(pixel->depth, 0.7);
  }
}

}  // namespace
}  // namespace vdbfuse
