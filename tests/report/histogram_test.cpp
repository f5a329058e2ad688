// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/histogram.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(Histogram, CountsByWeight) {
  const Histogram histogram = histogramOf({0.5f, 1.5f, 1.6f}, {2, 1, 1}, 0, 2, 2);
  EXPECT_THAT(histogram.shares, ElementsAre(DoubleNear(0.5, 1e-12), DoubleNear(0.5, 1e-12)));
}

TEST(Histogram, WhatLiesBeyondCountsAtTheEnds) {
  const Histogram histogram = histogramOf({-7, 0.5f, 99}, {1, 1, 2}, 0, 3, 3);
  EXPECT_THAT(histogram.shares, ElementsAre(DoubleNear(0.5, 1e-12), 0, DoubleNear(0.5, 1e-12)));
}

TEST(Histogram, WhatIsNotFiniteDoesNotCount) {
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_THAT(histogramOf({infinite, 0.1f}, {5, 1}, 0, 1, 2).shares, ElementsAre(1, 0));
  EXPECT_THAT(histogramOf({infinite}, {5}, 0, 1, 2).shares, ElementsAre(0, 0));
}

TEST(Histogram, SaysWhatIsWrong) {
  using test::messageOf;
  EXPECT_EQ(messageOf<InvalidArgument>([] { histogramOf({1}, {}, 0, 1, 2); }),
            "weights: there must be one a value");
  EXPECT_EQ(messageOf<InvalidArgument>([] { histogramOf({1}, {1}, 1, 1, 2); }), "high: must be above low");
  EXPECT_EQ(messageOf<InvalidArgument>([] { histogramOf({1}, {1}, 0, 1, 0); }), "bins: must be positive");
}

TEST(Histogram, ADrawingShowsEveryCurveWithItsName) {
  const Histogram histogram = histogramOf({0.5f}, {1}, 0, 2, 4);
  const std::string svg =
      drawHistograms({{"one", "#123456", histogram}, {"<two>", "#abcdef", histogram}}, {"metres", "share"});
  for (const char* part : {"<svg xmlns", "#123456", "#abcdef", ">one<", "&lt;two&gt;", ">metres<", ">share<"})
    EXPECT_THAT(svg, HasSubstr(part));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(Histogram, NothingToCountDrawsAFlatLine) {
  EXPECT_THAT(drawHistograms({{"none", "red", histogramOf({}, {}, 0, 1, 4)}}, {"", ""}),
              Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace vdbfuse
