// SPDX-License-Identifier: Apache-2.0
// Every format has a sample, and every sample is found out and read.
#include "formats/samples.h"

#include <gtest/gtest.h>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {
namespace {

using test::Sample;
using test::TemporaryFolder;

class Samples : public testing::TestWithParam<Sample> {};

TEST_P(Samples, AreFoundOutByLooking) {
  const TemporaryFolder folder;
  GetParam().write(folder.path());
  EXPECT_EQ(readDepthSet(folder / GetParam().input).format, GetParam().format);
}

TEST_P(Samples, HoldDepthsOfTheScene) {
  const TemporaryFolder folder;
  GetParam().write(folder.path());
  const DepthSet set = readDepthSet(folder / GetParam().input);
  EXPECT_GE(set.views.size(), 2u);
  test::expectOnSurface(set.views, 0.02, 0.1);
}

TEST_P(Samples, SayHowTheirNumbersAreUnderstood) {
  const TemporaryFolder folder;
  GetParam().write(folder.path());
  const DepthReading reading = readDepthSet(folder / GetParam().input).reading;
  EXPECT_FALSE(reading.stored.empty());
  EXPECT_FALSE(reading.invalid.empty());
  EXPECT_FALSE(reading.pose.empty());
  EXPECT_GT(reading.scale, 0);
}

TEST_P(Samples, AreScaledAsAskedFor) {
  const TemporaryFolder folder;
  GetParam().write(folder.path());
  const DepthSet set = readDepthSet(folder / GetParam().input);
  ReadOptions options;
  options.depth_scale = 2.0 * set.reading.scale;
  const DepthSet doubled = readDepthSet(folder / GetParam().input, options);
  EXPECT_DOUBLE_EQ(doubled.reading.scale, 2.0 * set.reading.scale);
  const Image<float> plain = set.views.load(0).map.depth, large = doubled.views.load(0).map.depth;
  ASSERT_TRUE(plain.sameSize(large));
  for (std::size_t i = 0; i < plain.size(); ++i)
    ASSERT_NEAR(large.data()[i], 2 * plain.data()[i], 1e-4F * large.data()[i]);
}

INSTANTIATE_TEST_SUITE_P(Formats, Samples, testing::ValuesIn(test::samples()),
                         [](const auto& test) { return test.param.format + "_" + test.param.variant; });

TEST(SamplesOfFormats, AreThereForEveryFormat) {
  for (const DepthSetFormat& format : depthSetFormats()) {
#ifndef VDBFUSE_TEST_PCL
    if (format.name == "pcd") continue;
#endif
    bool found = false;
    for (const Sample& sample : test::samples()) found = found || sample.format == format.name;
    EXPECT_TRUE(found) << format.name;
  }
}

}  // namespace
}  // namespace vdbfuse
