// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/summary.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

// A camera at (x, 0, 0) that looks along z at a wall at z = 2 to 3, noisy; one pixel in ten invalid.
View wall(double x, std::uint64_t seed) {
  View view;
  view.projection = Pinhole{40, 30, 40, 40, 19.5, 14.5, {}};
  view.world_from_camera.translation() = Eigen::Vector3d(x, 0, 0);
  view.map.depth = Image<float>(40, 30);
  view.map.confidence = Image<float>(40, 30);
  Random random(seed);
  for (int i = 0; i < 1200; ++i) {
    const bool valid = i % 10 != 3;
    view.map.depth.data()[i] = valid ? static_cast<float>(random.uniform(2.0, 3.0)) : kInvalidDepth;
    view.map.confidence.data()[i] = valid ? static_cast<float>(random.uniform()) : 100.0f;
  }
  return view;
}

TEST(Summary, CountsRangesAndBoxesAreThoseOfTheViews) {
  const ViewsSummary summary = summarise(ViewSequence::fromViews({wall(-1, 1), wall(4, 2)}));
  EXPECT_EQ(summary.views, 2u);
  EXPECT_EQ(summary.views_with_confidence, 2u);
  EXPECT_EQ(summary.views_with_color, 0u);
  EXPECT_EQ(summary.pixels, 2400u);
  EXPECT_EQ(summary.valid_pixels, 2160u);
  EXPECT_DOUBLE_EQ(summary.coverage(), 0.9);
  EXPECT_NEAR(summary.depth->smallest, 2.0, 0.01);
  EXPECT_NEAR(summary.depth->median, 2.5, 0.05);
  EXPECT_NEAR(summary.depth->largest, 3.0, 0.01);
  EXPECT_NEAR(summary.confidence->median, 0.5, 0.05);
  EXPECT_LE(summary.confidence->largest, 1.0);  // confidence of invalid pixels does not count
  EXPECT_EQ(summary.cameras.min(), Eigen::Vector3d(-1, 0, 0));
  EXPECT_EQ(summary.cameras.max(), Eigen::Vector3d(4, 0, 0));
  EXPECT_NEAR(summary.points.min().z(), 2.0, 0.02);
  EXPECT_NEAR(summary.points.max().z(), 3.0, 0.02);
  EXPECT_NEAR(summary.points.max().x(), 4 + 3 * 0.5, 0.15);
}

TEST(Summary, OneWildDepthMovesOnlyTheLargest) {
  View view = wall(0, 1);
  view.map.depth(20, 15) = 1e6f;
  const ViewsSummary summary = summarise(ViewSequence::fromViews({view}));
  EXPECT_EQ(summary.depth->largest, 1e6);
  EXPECT_LE(summary.depth->high, 3.0);
  EXPECT_LT(summary.points.max().norm(), 5.0);
}

TEST(Summary, SamplingChangesTheMedianLittleAndTheCountsNotAtAll) {
  const ViewSequence views = ViewSequence::fromViews({wall(0, 1), wall(0, 2), wall(0, 3)});
  const ViewsSummary all = summarise(views), few = summarise(views, {0.002, 400});
  EXPECT_EQ(all.valid_pixels, few.valid_pixels);
  EXPECT_EQ(all.depth->smallest, few.depth->smallest);
  EXPECT_NE(all.depth->median, few.depth->median);
  EXPECT_NEAR(all.depth->median, few.depth->median, 0.1);
}

TEST(Summary, NothingValidGivesNoRanges) {
  View view = wall(0, 1);
  view.map.depth = Image<float>(40, 30, kInvalidDepth);
  const ViewsSummary summary = summarise(ViewSequence::fromViews({view}));
  EXPECT_FALSE(summary.depth);
  EXPECT_FALSE(summary.confidence);
  EXPECT_TRUE(summary.points.isEmpty());
  EXPECT_EQ(summary.coverage(), 0.0);
  EXPECT_EQ(summarise(ViewSequence()).coverage(), 0.0);
}

TEST(Summary, ConfidenceThatIsNotFiniteDoesNotCount) {
  View view = wall(0, 1);
  view.map.confidence = Image<float>(40, 30, std::numeric_limits<float>::quiet_NaN());
  EXPECT_FALSE(summarise(ViewSequence::fromViews({view})).confidence);
}

TEST(Summary, IsTheSameForAnyNumberOfThreads) {
  std::vector<View> list;
  for (std::uint64_t i = 0; i < 9; ++i) list.push_back(wall(static_cast<double>(i), i));
  const ViewSequence views = ViewSequence::fromViews(std::move(list));
  const auto summary = [&](int threads) {
    const ThreadLimit limit(threads);
    return summarise(views, {0.01, 1000});
  };
  const ViewsSummary one = summary(1), two = summary(2);
  EXPECT_EQ(one.depth->high, two.depth->high);
  EXPECT_EQ(one.confidence->median, two.confidence->median);
  EXPECT_EQ(one.points.min(), two.points.min());
  EXPECT_EQ(one.points.max(), two.points.max());
}

TEST(Summary, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(summarise({}, {0.5, 10}), InvalidArgument);
  EXPECT_THROW(summarise({}, {0.1, 0}), InvalidArgument);
}

TEST(Summary, CanBeStopped) {
  const Progress stop([](std::string_view, double) { return false; });
  EXPECT_THROW(summarise(ViewSequence::fromViews({wall(0, 1)}), {}, stop), Cancelled);
}

}  // namespace
}  // namespace vdbfuse
