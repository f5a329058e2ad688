// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/no_return.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {
namespace {

// Depth 1 within the box, missing around it.
Image<float> boxImage() {
  Image<float> depth(60, 50, kInvalidDepth);
  for (int y = 15; y < 35; ++y)
    for (int x = 12; x < 48; ++x) depth(x, y) = 1.0f;
  return depth;
}

TEST(NoReturn, TheRingOfEmptySpaceAroundAnObjectIsEmpty) {
  const Image<float> depth = boxImage();
  const Image<std::uint8_t> empty = emptyRegions(depth);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 60; ++x) ASSERT_EQ(empty(x, y), depth(x, y) == kInvalidDepth) << x << " " << y;
  EXPECT_EQ(borderShare(empty), 1.0);
}

TEST(NoReturn, AHoleInTheMiddleIsNot) {
  Image<float> depth = boxImage();
  for (int y = 18; y < 32; ++y)
    for (int x = 20; x < 40; ++x) depth(x, y) = kInvalidDepth;
  const Image<std::uint8_t> empty = emptyRegions(depth);
  EXPECT_EQ(empty(30, 25), 0);
  EXPECT_EQ(empty(5, 25), 1);
}

TEST(NoReturn, IsolatedMissesAndNarrowStripsAreChance) {
  Image<float> depth(60, 50, 1.0f);
  for (int x = 0; x < 60; x += 3) depth(x, 0) = kInvalidDepth;  // on the border, but single
  for (int y = 0; y < 50; ++y)
    for (int x = 30; x < 38; ++x) depth(x, y) = kInvalidDepth;  // eight wide: does not survive 9×9
  const Image<std::uint8_t> empty = emptyRegions(depth);
  EXPECT_EQ(std::count(empty.begin(), empty.end(), 1), 0);
  for (int y = 0; y < 50; ++y) depth(38, y) = kInvalidDepth;  // nine wide
  EXPECT_EQ(emptyRegions(depth)(34, 25), 1);
  EXPECT_EQ(borderShare(empty), 0.0);
}

TEST(NoReturn, DepthsThatAreProbablyWrongDoNotInterruptEmptySpace) {
  Image<float> depth = boxImage();
  Image<float> outlier(60, 50, 0.01f);
  for (int y = 0; y < 50; y += 3) {
    for (int x = 0; x < 60; x += 3) {
      if (depth(x, y) != kInvalidDepth) continue;
      depth(x, y) = 2.0f;
      outlier(x, y) = 0.9f;
    }
  }
  EXPECT_EQ(emptyRegions(depth)(5, 5), 0);
  EXPECT_EQ(emptyRegions(depth, outlier)(5, 5), 1);
  EXPECT_EQ(emptyRegions(depth, outlier)(30, 25), 0);
  std::fill(outlier.begin(), outlier.end(), 0.5f);  // who knows
  EXPECT_EQ(emptyRegions(depth, outlier)(5, 5), 0);
}

TEST(NoReturn, NothingButDepthsThatAreProbablyWrongIsNotEmpty) {
  const Image<float> depth(60, 50, 1.0f), outlier(60, 50, 0.9f);
  EXPECT_EQ(borderShare(emptyRegions(depth, outlier)), 0.0);
}

TEST(NoReturn, WhereOthersMeasuredASurfaceIsAHole) {
  const Image<float> depth = boxImage();
  Image<std::uint8_t> missed(60, 50, 0);
  EXPECT_EQ(emptyRegions(depth, {}, missed), emptyRegions(depth));
  missed(5, 25) = missed(3, 20) = 1;  // a few wrong pixels
  EXPECT_EQ(emptyRegions(depth, {}, missed), emptyRegions(depth));
  for (int y = 0; y < 50; y += 2)
    for (int x = 0; x < 12; x += 2) missed(x, y) = 1;
  const Image<std::uint8_t> empty = emptyRegions(depth, {}, missed);
  for (int y = 0; y < 50; ++y) ASSERT_EQ(empty(5, y), 0) << y;
  for (int y = 0; y < 50; ++y) ASSERT_EQ(empty(54, y), 1) << y;
}

TEST(NoReturn, FullAndTinyImagesAreNoTrouble) {
  EXPECT_EQ(borderShare(emptyRegions(Image<float>(3, 2, kInvalidDepth))), 1.0);
  EXPECT_EQ(borderShare(emptyRegions(Image<float>(3, 2, 1.0f))), 0.0);
  EXPECT_EQ(borderShare({}), 0.0);
}

}  // namespace
}  // namespace vdbfuse
