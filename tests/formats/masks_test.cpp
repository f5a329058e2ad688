// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

// Two views of 4x3 pixels, everything at 2.
void writeViews(const std::filesystem::path& folder) {
  MvsnetWriter writer(folder);
  for (int i = 0; i < 2; ++i) {
    View view;
    view.projection = Pinhole{4, 3, 4, 4, 1.5, 1, {}};
    view.map.depth = Image<float>(4, 3, 2.0f);
    writer.add(view);
  }
}

// The left column is background.
Image<std::uint8_t> mask(std::uint8_t object = 255) {
  Image<std::uint8_t> mask(4, 3, object);
  for (int y = 0; y < 3; ++y) mask(0, y) = 0;
  return mask;
}

struct Scan : TemporaryFolder {
  Scan() {
    writeViews(path());
    std::filesystem::create_directory(*this / "masks");
    std::filesystem::create_directory(*this / "other");
  }
  DepthSet read(const std::string& masks = "") const {
    ReadOptions options;
    if (!masks.empty()) options.masks = *this / masks;
    return readDepthSet(path(), options);
  }
  std::string complaint(const std::string& masks = "") const {
    const std::string message = messageOf<IoError>([&] { read(masks); });
    EXPECT_EQ(message.find(path().string() + "/"), 0u) << message;
    return message.substr(path().string().size() + 1);
  }
};

void expectMasked(const DepthMap& map) {
  ASSERT_FALSE(map.mask.empty());
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      EXPECT_EQ(isOutsideMask(map, x, y), x == 0);
      EXPECT_EQ(map.depth(x, y), x == 0 ? kInvalidDepth : 2.0f);
    }
  }
}

TEST(Masks, LieInTheDataSetForTheViewsThatHaveOne) {
  const Scan scan;
  EXPECT_TRUE(scan.read().views.load(0).map.mask.empty());
  writePng(scan / "masks/00000000.png", mask());
  const DepthSet set = scan.read();
  expectMasked(set.views.load(0).map);
  EXPECT_TRUE(set.views.load(1).map.mask.empty());
  EXPECT_NE(std::find(set.notes.begin(), set.notes.end(), "silhouette masks for 1 of 2 views"),
            set.notes.end());
}

TEST(Masks, BesideTheFramesOfADepthCamera) {
  const TemporaryFolder folder;
  writePng(folder / "a.depth.png", Image<std::uint16_t>(4, 3, std::uint16_t{2000}));
  writeText(folder / "a.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  writeText(folder / "intrinsics.txt", "4 0 1.5\n0 4 1.5\n0 0 1\n");
  writePng(folder / "a.mask.png", mask(1));  // any value above 0 is the object
  expectMasked(readDepthSet(folder.path()).views.load(0).map);
}

TEST(Masks, AFolderThatIsNamedHasOneForEveryView) {
  const Scan scan;
  writePng(scan / "masks/00000000.png", Image<std::uint8_t>(4, 3));  // not this one
  Image<Rgb8> colour(4, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 1; x < 4; ++x) colour(x, y) = {0, 0, 9};
  writePng(scan / "other/00000000.png", colour);
  EXPECT_EQ(scan.complaint("other"),
            "other/00000001.png: expected the mask of view 00000001, found nothing of that name");
  writePng(scan / "other/00000001.png", mask());
  for (const std::size_t i : {0u, 1u}) expectMasked(scan.read("other").views.load(i).map);
}

TEST(Masks, ThatDoNotFitAreNamed) {
  const Scan scan;
  EXPECT_EQ(scan.complaint("nowhere"), "nowhere: expected a folder of masks, found nothing of that name");
  EXPECT_EQ(scan.complaint("cams/00000000_cam.txt"),
            "cams/00000000_cam.txt: expected a folder of masks, found a file");
  writePng(scan / "masks/00000001.png", Image<std::uint8_t>(3, 4, std::uint8_t{1}));
  EXPECT_EQ(scan.complaint(),
            "masks/00000001.png: expected a mask of 4x3 pixels as the depth map, found 3x4");
  writePng(scan / "masks/00000001.png", Image<std::uint16_t>(4, 3, std::uint16_t{255}));
  EXPECT_EQ(scan.complaint(), "masks/00000001.png: expected a mask of at most 8 bits, found 16 bits");
  writeText(scan / "masks/00000001.png", "GIF89a");
  EXPECT_EQ(scan.complaint(), "masks/00000001.png: expected a PNG file, found another signature");
}

TEST(Masks, ThatAreCutShortAreNamedWhenTheViewIsLoaded) {
  const Scan scan;
  writePng(scan / "masks/00000001.png", mask());
  const std::string whole = test::readText(scan / "masks/00000001.png");
  writeText(scan / "masks/00000001.png", whole.substr(0, whole.size() - 20));
  const DepthSet set = scan.read();
  const std::string message = messageOf<IoError>([&] { set.views.load(1); });
  EXPECT_EQ(message.find((scan / "masks/00000001.png").string()), 0u) << message;
}

}  // namespace
}  // namespace vdbfuse
