// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/formats/depth_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

void writeRgbd(const std::filesystem::path& folder) {
  writePng(folder / "a.depth.png", Image<std::uint16_t>(4, 4, std::uint16_t{1000}));
  writeText(folder / "a.pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 0\n");
  writeText(folder / "intrinsics.txt", "4 0 1.5\n0 4 1.5\n0 0 1\n");
}

void writeMvsnet(const std::filesystem::path& folder) {
  View view;
  view.projection = Pinhole{4, 4, 4, 4, 1.5, 1.5, {}};
  view.map.depth = Image<float>(4, 4, 2.0f);
  MvsnetWriter(folder).add(view);
}

TEST(DepthSet, FormatIsFoundByContent) {
  const TemporaryFolder rgbd, mvsnet;
  writeRgbd(rgbd.path());
  writeMvsnet(mvsnet.path());
  EXPECT_EQ(readDepthSet(rgbd.path()).format, "rgbd");
  EXPECT_EQ(readDepthSet(mvsnet.path()).format, "mvsnet");
}

TEST(DepthSet, CompleteFormatWinsOverOneThatFitsPartly) {
  const TemporaryFolder folder;
  writeMvsnet(folder.path());
  writePng(folder / "a.depth.png", Image<std::uint16_t>(4, 4, std::uint16_t{1000}));
  EXPECT_EQ(readDepthSet(folder.path()).format, "mvsnet");
}

TEST(DepthSet, NamedFormatOverridesWhatIsFound) {
  const TemporaryFolder folder;
  writeRgbd(folder.path());
  writeMvsnet(folder.path());
  ReadOptions options;
  for (const char* name : {"rgbd", "mvsnet"}) {
    options.format = name;
    EXPECT_EQ(readDepthSet(folder.path(), options).format, name);
  }
  options.format = "vrml";
  EXPECT_THAT(messageOf<InvalidArgument>([&] { readDepthSet(folder.path(), options); }),
              testing::AllOf(testing::StartsWith("format: expected one of rgbd, "),
                             testing::EndsWith(", found 'vrml'")));
}

TEST(DepthSet, UnknownFolderSaysWhatLiesInIt) {
  const TemporaryFolder folder;
  const std::string expected =
      ": expected a data set of a known format (vdbfuse formats PATH says what each lacks), found ";
  EXPECT_EQ(messageOf<IoError>([&] { readDepthSet(folder.path()); }),
            folder.path().string() + expected + "an empty folder");
  for (const char* name : {"e", "d", "c", "b"}) writeText(folder / name, "x");
  std::filesystem::create_directory(folder / "a");
  EXPECT_EQ(messageOf<IoError>([&] { readDepthSet(folder.path()); }),
            folder.path().string() + expected + "a folder of a/, b, c, d and 1 more");
}

TEST(DepthSet, FileOrNothingInsteadOfAFolderIsSaid) {
  const TemporaryFolder folder;
  writeText(folder / "file", "x");
  EXPECT_EQ(
      messageOf<IoError>([&] { readDepthSet(folder / "file"); }),
      (folder / "file").string() +
          ": expected a data set of a known format (vdbfuse formats PATH says what each lacks), found a "
          "file of another kind");
  ReadOptions options;
  for (const char* name : {"rgbd", "mvsnet"}) {
    options.format = name;
    EXPECT_EQ(messageOf<IoError>([&] { readDepthSet(folder / "file", options); }),
              (folder / "file").string() + ": expected a folder, found a file");
  }
  EXPECT_EQ(messageOf<IoError>([&] { readDepthSet(folder / "none"); }),
            (folder / "none").string() + ": expected a data set of depth maps, found nothing of that name");
}

TEST(DepthSet, PartlyRightFolderIsReadSoThatTheReaderNamesWhatIsMissing) {
  const TemporaryFolder folder;
  writeRgbd(folder.path());
  std::filesystem::remove(folder / "intrinsics.txt");
  EXPECT_EQ(messageOf<IoError>([&] { readDepthSet(folder.path()); }),
            folder.path().string() +
                ": expected an intrinsics file (*intrinsics*.txt), or --intrinsics, found none");
}

TEST(DepthSet, EveryWrongOptionIsListed) {
  ReadOptions options;
  options.depth_scale = 0.0;
  options.depth_kind = DepthKind::Disparity;
  options.min_depth = -1;
  options.max_depth = -2;
  EXPECT_THAT(validate(options),
              testing::ElementsAre("depth_scale must be above 0", "depth_kind disparity needs a baseline",
                                   "min_depth must not be below 0", "max_depth must be above min_depth"));
  options.baseline = -1.0;
  EXPECT_THAT(validate(options), testing::Contains("baseline must be above 0"));
  EXPECT_THROW(readDepthSet("anything", options), InvalidArgument);
  EXPECT_THAT(validate(ReadOptions{}), testing::IsEmpty());
}

TEST(DepthSet, EveryFormatIsDescribed) {
  for (const DepthSetFormat& format : depthSetFormats()) {
    EXPECT_FALSE(format.name.empty());
    EXPECT_FALSE(format.description.empty());
    EXPECT_TRUE(format.layout.ends_with('\n')) << format.name;
  }
}

}  // namespace
}  // namespace vdbfuse
