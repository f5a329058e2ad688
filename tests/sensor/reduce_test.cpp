// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/reduce.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

View slope(int width, int height) {
  View view;
  view.name = "slope";
  view.projection = Pinhole{width, height, 100, 100, 0.5 * (width - 1), 0.5 * (height - 1), {}};
  view.map.depth = Image<float>(width, height);
  view.map.confidence = Image<float>(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      view.map.depth(x, y) = 2.0f + 0.01f * static_cast<float>(x);
      view.map.confidence(x, y) = static_cast<float>(y * width + x);
    }
  }
  return view;
}

TEST(Reduced, PointsStayWhereTheyWereWithinTheBlock) {
  const View view = slope(12, 9), small = reduced(view, 3);
  ASSERT_EQ(small.map.depth.width(), 4);
  ASSERT_EQ(small.map.depth.height(), 3);
  EXPECT_TRUE(validate(small).empty());
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      // The middle column of the block has the middle depth.
      EXPECT_EQ(small.map.depth(x, y), view.map.depth(3 * x + 1, 0));
      EXPECT_NEAR((worldPoint(small, x, y) - worldPoint(view, 3 * x + 1, 3 * y + 1)).norm(), 0, 1e-9);
      const int pixel = static_cast<int>(small.map.confidence(x, y));
      EXPECT_EQ(pixel % 12, 3 * x + 1);
      EXPECT_EQ(pixel / 12 / 3, y);
    }
  }
}

TEST(Reduced, AWildDepthIsNotTheMiddleOne) {
  View view = slope(6, 6);
  view.map.depth(1, 1) = 9.0f, view.map.depth(2, 0) = 0.1f;
  const View small = reduced(view, 3);
  EXPECT_NEAR(small.map.depth(0, 0), 2.01f, 0.011f);
  EXPECT_EQ(reduced(view, 3, Reduction::Pick).map.depth(0, 0), 9.0f);
}

TEST(Reduced, ABlockThatIsMostlyMissingIsMissing) {
  View view = slope(6, 3);
  for (int i = 0; i < 5; ++i) view.map.depth(i % 3, i / 3) = kInvalidDepth;  // five of nine
  for (int i = 0; i < 4; ++i) view.map.depth(3 + i % 3, i / 3) = kInvalidDepth;
  const View small = reduced(view, 3);
  EXPECT_EQ(small.map.depth(0, 0), kInvalidDepth);
  EXPECT_NE(small.map.depth(1, 0), kInvalidDepth);
}

TEST(Reduced, SizesThatDoNotDivideKeepTheirLastPixels) {
  for (int width = 5; width < 12; ++width) {
    const View small = reduced(slope(width, 7), 3);
    EXPECT_TRUE(validate(small).empty()) << width;
    for (const float d : small.map.depth) EXPECT_GE(d, 2.0f) << width;
  }
}

TEST(Reduced, ByOneIsTheViewItself) {
  const View view = slope(5, 4), same = reduced(view, 1);
  EXPECT_EQ(same.map.depth, view.map.depth);
  EXPECT_EQ(same.projection, view.projection);
}

}  // namespace
}  // namespace vdbfuse
