// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/color_map.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

double lightness(const Rgb8& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }

TEST(ColorMap, DivergingColorsRunFromBlueOverWhiteToRed) {
  const Rgb8 low = divergingColor(-1), middle = divergingColor(0), high = divergingColor(1);
  EXPECT_GT(low[2], low[0] + 50);
  EXPECT_GT(high[0], high[2] + 50);
  for (const int channel : middle) EXPECT_GT(channel, 240);
}

TEST(ColorMap, SequentialColorsGrowLighterThroughout) {
  for (int i = 0; i < 100; ++i)
    EXPECT_LE(lightness(sequentialColor(i / 100.0)), lightness(sequentialColor((i + 1) / 100.0)));
  EXPECT_GT(lightness(sequentialColor(1)), lightness(sequentialColor(0)) + 150);
}

TEST(ColorMap, ValuesBeyondTheEndsAreClamped) {
  EXPECT_EQ(divergingColor(-7), divergingColor(-1));
  EXPECT_EQ(divergingColor(7), divergingColor(1));
  EXPECT_EQ(sequentialColor(-7), sequentialColor(0));
  EXPECT_EQ(sequentialColor(7), sequentialColor(1));
}

}  // namespace
}  // namespace vdbfuse
