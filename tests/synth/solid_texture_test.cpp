// SPDX-License-Identifier: Apache-2.0
#include "synth/solid_texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse::synth {
namespace {

constexpr double kPixel = 0.002;  // of a picture 640 pixels wide
constexpr int kSide = 256;

// Green of a plane, in grey levels.
Image<float> plane(const SolidTexture& texture, double blur) {
  Image<float> image(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x)
      image(x, y) =
          static_cast<float>(255 * texture.albedo({0.1 + kPixel * x, 0.3, kPixel * y - 0.2}, blur).y());
  return image;
}

// Root mean square of the differences between the means of neighbouring squares of `size` pixels.
double contrast(const Image<float>& image, int size) {
  const auto mean = [&](int column, int row) {
    double sum = 0;
    for (int y = row * size; y < (row + 1) * size; ++y)
      for (int x = column * size; x < (column + 1) * size; ++x) sum += image(x, y);
    return sum / (size * size);
  };
  double squares = 0;
  int count = 0;
  for (int row = 0; row < kSide / size; ++row)
    for (int column = 0; column + 1 < kSide / size; ++column, ++count)
      squares += std::pow(mean(column, row) - mean(column + 1, row), 2);
  return std::sqrt(squares / count);
}

TEST(SolidTexture, HasContrastAtAllScalesFromOnePixelToFifty) {
  const Image<float> image = plane(SolidTexture(1), kPixel);
  for (const int size : {1, 2, 4, 8, 16, 32, 50}) EXPECT_GT(contrast(image, size), 10) << size;
}

TEST(SolidTexture, DetailsSmallerThanTheBlurFade) {
  const Image<float> blurred = plane(SolidTexture(1), 16 * kPixel);
  EXPECT_LT(contrast(blurred, 1), 3);
  EXPECT_GT(contrast(blurred, 32), 10);
}

TEST(SolidTexture, AnotherSeedIsAnotherTexture) {
  const Image<float> one = plane(SolidTexture(1), kPixel), two = plane(SolidTexture(2), kPixel);
  double product = 0, squares = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    product += (one.data()[i] - 128) * (two.data()[i] - 128);
    squares += (one.data()[i] - 128) * (one.data()[i] - 128);
  }
  EXPECT_LT(std::abs(product), 0.3 * squares);
}

}  // namespace
}  // namespace vdbfuse::synth
