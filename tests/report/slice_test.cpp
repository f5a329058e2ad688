// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/slice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/report/color_map.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

const Box kBox(Vector3d(-1, -2, -3), Vector3d(1, 2, 3));

TEST(Slice, AxesRunToTheRightAndUpwardsAsStated) {
  struct Case {
    int axis, right, up;
  };
  for (const auto& [axis, right, up] : {Case{0, 1, 2}, Case{1, 0, 2}, Case{2, 0, 1}}) {
    const auto slice = [axis = axis](int shown) {
      return sampleSlice([&](const Vector3d& p) { return p[shown]; }, kBox, {axis, 0.25}, 60);
    };
    const Image<float> along_right = slice(right), along_up = slice(up), across = slice(axis);
    const int w = along_right.width(), h = along_right.height();
    EXPECT_EQ(std::max(w, h), 60);
    EXPECT_NEAR(static_cast<double>(w) / h, kBox.sizes()[right] / kBox.sizes()[up], 0.02);
    const double half_pixel = 0.5 * kBox.sizes()[right] / w;
    EXPECT_NEAR(along_right(0, 0), kBox.min()[right] + half_pixel, 1e-5);
    EXPECT_NEAR(along_right(w - 1, 0), kBox.max()[right] - half_pixel, 1e-5);
    EXPECT_NEAR(along_up(0, 0), kBox.max()[up] - half_pixel, 1e-5);
    EXPECT_NEAR(along_up(0, h - 1), kBox.min()[up] + half_pixel, 1e-5);
    EXPECT_FLOAT_EQ(across(3, 5), 0.25f);
  }
}

TEST(Slice, OutsideIsBlueInsideIsRedAndALineParts) {
  const ScalarField sphere = [](const Vector3d& p) { return p.norm() - 0.6; };
  const Box box(Vector3d::Constant(-1), Vector3d::Constant(1));
  const Image<float> values = sampleSlice(sphere, box, {2, 0}, 101);
  const Image<Rgb8> picture = drawSlice(values);
  EXPECT_GT(picture(0, 0)[2], picture(0, 0)[0]);
  EXPECT_GT(picture(50, 50)[0], picture(50, 50)[2]);
  int line = 0;
  for (int y = 0; y < 101; ++y)
    for (int x = 0; x < 101; ++x) {
      if (picture(x, y) != Rgb8{0, 0, 0}) continue;
      ++line;
      EXPECT_LT(std::abs(values(x, y)), 0.03);
    }
  EXPECT_GT(line, 150);
}

TEST(Slice, UnknownValuesAreGrey) {
  Image<float> values(2, 1, 1.0f);
  values(0, 0) = std::numeric_limits<float>::quiet_NaN();
  for (const SliceColors colors : {SliceColors::Signed, SliceColors::Sequential}) {
    const Rgb8 grey{128, 128, 128};
    EXPECT_EQ(drawSlice(values, {colors})(0, 0), grey);
    EXPECT_NE(drawSlice(values, {colors})(1, 0), grey);
  }
}

TEST(Slice, AGivenRangeIsKept) {
  Image<float> values(3, 1);
  values(0, 0) = 0, values(1, 0) = 0.5f, values(2, 0) = 9;
  const Image<Rgb8> picture = drawSlice(values, {SliceColors::Sequential, 0, 1});
  EXPECT_EQ(picture(0, 0), sequentialColor(0));
  EXPECT_EQ(picture(1, 0), sequentialColor(0.5));
  EXPECT_EQ(picture(2, 0), sequentialColor(1));
}

TEST(Slice, OneWildValueDoesNotTakeTheColoursFromTheRest) {
  Image<float> values(100, 1);
  for (int x = 0; x < 100; ++x) values(x, 0) = static_cast<float>(x);
  values(99, 0) = 1e9f;
  EXPECT_NE(drawSlice(values, {SliceColors::Sequential})(10, 0),
            drawSlice(values, {SliceColors::Sequential})(60, 0));
}

TEST(Slice, AnImpossiblePlaneIsRefused) {
  const ScalarField field = [](const Vector3d&) { return 0.0; };
  EXPECT_THROW(sampleSlice(field, kBox, {3, 0}, 10), InvalidArgument);
  EXPECT_THROW(sampleSlice(field, kBox, {0, 0}, 0), InvalidArgument);
  EXPECT_THROW(sampleSlice(field, Box(), {0, 0}, 10), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
