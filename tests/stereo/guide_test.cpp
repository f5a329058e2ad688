// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "stereo/bit_rows.h"
#include "stereo/surface.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kWidth = 150, kHeight = 40;

TEST(BitRows, AreMovedAcrossWordsAndEndAtTheBorder) {
  const auto is = [](int x, int y) { return (7 * x + 3 * y) % 5 < 2; };
  const BitRows rows(kWidth, kHeight, is);
  for (int y = -1; y <= kHeight; ++y) {
    for (const int shift : {-63, -12, -1, 0, 1, 12, 63}) {
      for (int x = 0; x < kWidth; ++x) {
        const int from = x + shift;
        const bool expected = from >= 0 && from < kWidth && y >= 0 && y < kHeight && is(from, y);
        const std::uint64_t word = rows.moved(x / BitRows::kBits, y, shift);
        ASSERT_EQ((word >> (x % BitRows::kBits) & 1) == 1, expected) << x << ' ' << y << ' ' << shift;
      }
    }
  }
}

// The plane of the nearest pixel with a score in one of eight directions, found one pixel after the other.
float planeFromNearest(const DepthLayer& layer, const PlaneMap& planes, int x, int y) {
  for (int distance = 1; distance <= 12; ++distance) {
    float best = 0, found = 0;
    for (const auto& [ux, uy] :
         {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}) {
      const int from_x = x + distance * ux, from_y = y + distance * uy;
      if (!layer.score.contains(from_x, from_y) || planes.share(from_x, from_y) < 0.5F) continue;
      if (layer.score(from_x, from_y) <= best) continue;
      best = layer.score(from_x, from_y);
      found = planes.value(from_x, from_y) - static_cast<float>(distance * ux) * planes.dx(from_x, from_y) -
              static_cast<float>(distance * uy) * planes.dy(from_x, from_y);
    }
    if (best > 0) return found;
  }
  return 0;
}

TEST(Guide, WhatIsNotAgreedWithTakesThePlaneOfTheNearestThatIs) {
  std::mt19937 random(1);
  DepthLayer layer = emptyLayer(kWidth, kHeight);
  PlaneMap planes{layer.score, layer.score, layer.score, layer.score};
  for (std::size_t i = 0; i < layer.score.size(); ++i) {
    layer.score.data()[i] = static_cast<float>(random() % 4);
    planes.share.data()[i] = random() % 60 == 0 ? 1.0F : 0.0F;
    planes.value.data()[i] = 1 + static_cast<float>(random() % 100) / 100;
    planes.dx.data()[i] = 0.01F, planes.dy.data()[i] = -0.02F;
  }
  const Guide guide = guideOf(layer, planes);
  int found = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool is_foreign = planes.share(x, y) == 0;
      ASSERT_EQ(guide.is_foreign(x, y) != 0, is_foreign);
      const float expected = is_foreign ? planeFromNearest(layer, planes, x, y) : planes.value(x, y);
      ASSERT_NEAR(guide.inverse_depth(x, y), expected, 1e-6F) << x << ' ' << y;
      found += is_foreign && expected > 0;
    }
  }
  EXPECT_GT(found, 1000);
}

}  // namespace
}  // namespace vdbfuse::stereo
