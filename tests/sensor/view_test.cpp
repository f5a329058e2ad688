// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/view.h"

#include <gtest/gtest.h>

#include <limits>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

View goodView(const std::string& name = "v") {
  View view;
  view.name = name;
  view.projection = Pinhole{3, 2, 2, 2, 1, 0.5, {}};
  view.world_from_camera.translation() = Eigen::Vector3d(10, 0, 0);
  view.map.depth = Image<float>(3, 2, 2.0f);
  return view;
}

TEST(View, APixelsWorldPointIsItsRayAtItsDepth) {
  EXPECT_EQ(worldPoint(goodView(), 2, 0), Eigen::Vector3d(11, -0.5, 2));
}

TEST(View, EveryKindOfBadDepthBecomesTheOneInvalid) {
  Image<float> depth(6, 1, 1.0f);
  depth(0, 0) = kNan, depth(1, 0) = -kNan, depth(2, 0) = -1.0f;
  depth(3, 0) = std::numeric_limits<float>::infinity(), depth(4, 0) = -0.0f;
  normaliseInvalid(depth);
  for (int x = 0; x < 5; ++x) EXPECT_TRUE(depth(x, 0) == 0 && !std::signbit(depth(x, 0))) << x;
  EXPECT_EQ(depth(5, 0), 1.0f);
}

TEST(View, EverythingThatIsWrongIsReported) {
  EXPECT_TRUE(validate(goodView()).empty());
  View bad = goodView();
  std::get<Pinhole>(bad.projection).fx = -1;
  bad.map.depth = Image<float>(4, 2, 1.0f);
  bad.map.confidence = Image<float>(3, 2);
  bad.world_from_camera.linear() *= 1.01;
  const std::vector<std::string> expected = {
      "focal lengths must be positive", "the depth map is 4x2, its projection is for 3x2",
      "confidence and depth differ in size", "the pose is not a rigid transform"};
  EXPECT_EQ(validate(bad), expected);
}

TEST(View, APoseMustBeFiniteInItsPositionToo) {
  View bad = goodView();
  bad.world_from_camera.translation().y() = kNan;
  EXPECT_EQ(validate(bad), std::vector<std::string>{"the pose is not a rigid transform"});
  bad = goodView();
  bad.world_from_camera.linear()(0, 0) = kNan;
  EXPECT_EQ(validate(bad).size(), 1u);
}

TEST(ViewSequence, LoadsOnDemandAndNormalises) {
  std::vector<std::size_t> asked;
  std::vector<ViewHeader> headers(3, goodView());
  const ViewSequence sequence(headers, [&](std::size_t index) {
    asked.push_back(index);
    DepthMap map = goodView().map;
    map.depth(0, 0) = kNan;
    return map;
  });
  EXPECT_EQ(sequence.size(), 3u);
  EXPECT_TRUE(asked.empty());
  EXPECT_EQ(sequence.load(2).map.depth(0, 0), kInvalidDepth);
  EXPECT_EQ(asked, std::vector<std::size_t>{2});
}

TEST(ViewSequence, AViewThatCannotBeUsedIsNamed) {
  View bad = goodView("broken");
  bad.map.depth = Image<float>(2, 2, 1.0f);
  const ViewSequence sequence = ViewSequence::fromViews({goodView(), bad});
  EXPECT_NO_THROW(sequence.load(0));
  EXPECT_EQ(test::messageOf<InvalidArgument>([&] { sequence.load(1); }),
            "view broken: the depth map is 2x2, its projection is for 3x2");
}

TEST(ViewSequence, TheFirstViewsAreACopyThatStopsEarlier) {
  const ViewSequence all = ViewSequence::fromViews({goodView("a"), goodView("b"), goodView("c")});
  EXPECT_EQ(all.first(2).size(), 2u);
  EXPECT_EQ(all.first(2).load(1).name, "b");
  EXPECT_EQ(all.first(9).size(), 3u);
  EXPECT_EQ(all.size(), 3u);
  EXPECT_TRUE(ViewSequence().empty());
}

TEST(Mask, WhatIsMeasuredOutsideItIsBackground) {
  View view;
  view.projection = Pinhole{2, 1, 1, 1, 0, 0, {}};
  view.map.depth = Image<float>(2, 1, 3.0f);
  view.map.mask = Image<std::uint8_t>(2, 1);
  view.map.mask(1, 0) = 255;
  EXPECT_TRUE(isOutsideMask(view.map, 0, 0));
  EXPECT_FALSE(isOutsideMask(view.map, 1, 0));
  const DepthMap loaded = ViewSequence::fromViews({view}).load(0).map;
  EXPECT_EQ(loaded.depth(0, 0), kInvalidDepth);
  EXPECT_EQ(loaded.depth(1, 0), 3.0f);
  view.map.mask = {};
  EXPECT_FALSE(isOutsideMask(view.map, 0, 0));
  EXPECT_EQ(ViewSequence::fromViews({view}).load(0).map.depth, view.map.depth);
}

TEST(Mask, OfAnotherSizeIsReported) {
  View view;
  view.projection = Pinhole{2, 1, 1, 1, 0, 0, {}};
  view.map.depth = Image<float>(2, 1, 3.0f);
  view.map.mask = Image<std::uint8_t>(1, 2);
  EXPECT_EQ(validate(view), std::vector<std::string>{"mask and depth differ in size"});
}

}  // namespace
}  // namespace vdbfuse
