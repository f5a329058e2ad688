// SPDX-License-Identifier: Apache-2.0
// What writeDepthSet() writes, readDepthSet() gives back, in every format that can be written.
#include <gtest/gtest.h>

#include <string>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {
namespace {

using test::TemporaryFolder;

std::vector<std::string> writableFormats() {
  std::vector<std::string> names;
  for (const DepthSetFormat& format : depthSetFormats()) {
    if (format.write != nullptr) names.emplace_back(format.name);
  }
  return names;
}

class RoundTrip : public testing::TestWithParam<std::string> {};

TEST_P(RoundTrip, GivesPosesCamerasAndDepthsBack) {
  const TemporaryFolder folder;
  const std::vector<View> truth = test::tinyViews();
  writeDepthSet(folder / "set", GetParam(), ViewSequence::fromViews(truth));
  const DepthSet set = readDepthSet(folder / "set");
  EXPECT_EQ(set.format, GetParam());
  // Half a millimetre where whole millimetres are stored.
  test::expectSameViews(set.views, truth, 0.00051);
}

TEST_P(RoundTrip, GivesColoursBack) {
  const TemporaryFolder folder;
  const std::vector<View> truth = test::tinyViews(2);
  writeDepthSet(folder / "set", GetParam(), ViewSequence::fromViews(truth));
  const View view = readDepthSet(folder / "set").views.load(1);
  if (view.map.color.empty()) GTEST_SKIP() << GetParam() << " holds no colours";
  EXPECT_EQ(view.map.color, truth[1].map.color);
}

TEST_P(RoundTrip, RefusesAFolderThatIsNotEmpty) {
  const TemporaryFolder folder;
  test::writeText(folder / "mine.txt", "precious");
  EXPECT_EQ(test::messageOf<IoError>([&] {
              writeDepthSet(folder.path(), GetParam(), ViewSequence::fromViews(test::tinyViews()));
            }),
            folder.path().string() + ": expected an empty folder, found one that is not empty");
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip, testing::ValuesIn(writableFormats()),
                         [](const auto& test) { return test.param; });

TEST(WriteDepthSet, SaysWhichFormatsCanBeWritten) {
  const TemporaryFolder folder;
  const std::string message = test::messageOf<InvalidArgument>(
      [&] { writeDepthSet(folder / "set", "pcd", ViewSequence::fromViews(test::tinyViews())); });
  EXPECT_NE(message.find("'pcd', which can be read only"), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(folder / "set"));
}

TEST(WriteDepthSet, RefusesDepthsThatDoNotFitIntoWholeNumbers) {
  const TemporaryFolder folder;
  WriteOptions options;
  options.depth_scale = 0.00001;
  const std::string message = test::messageOf<InvalidArgument>(
      [&] { writeDepthSet(folder / "set", "rgbd", ViewSequence::fromViews(test::tinyViews()), options); });
  EXPECT_NE(message.find("does not fit into 16 bits in steps of 1e-05"), std::string::npos) << message;
}

}  // namespace
}  // namespace vdbfuse
