// SPDX-License-Identifier: Apache-2.0
#include "formats/lens.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vdbfuse/geometry/distortion.h"

namespace vdbfuse {
namespace {

Lens brown(double k1, double p1 = 0) { return {{80, 60, 70, 72, 38.5, 30.25, {k1, 0, p1, 0, 0}}, 0}; }
Lens measured(double k) { return {{80, 60, 70, 72, 38.5, 30.25, {}}, k}; }

// A picture of a smooth function of the direction that a pixel of the lens looks in.
double brightnessAt(const Eigen::Vector2d& ray) {
  return 0.5 + 0.3 * std::sin(4 * ray.x()) * std::cos(3 * ray.y());
}

// The ideal ray of a pixel, by going the way that pixelOf() inverts, or by Newton's method of the module
// geometry.
Eigen::Vector2d rayOf(const Lens& lens, double x, double y) {
  const Pinhole& c = lens.camera;
  const Eigen::Vector2d seen((x - c.cx) / c.fx, (y - c.cy) / c.fy);
  if (lens.measured_radial != 0) return seen * (1 + lens.measured_radial * seen.squaredNorm());
  return undistort(c, seen);
}

Photograph photographThrough(const Lens& lens) {
  Photograph photograph;
  photograph.camera = withoutDistortion(lens);
  photograph.brightness = Image<float>(80, 60);
  photograph.color = Image<Rgb8>(80, 60);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) {
      const double value = brightnessAt(rayOf(lens, x, y));
      photograph.brightness(x, y) = static_cast<float>(value);
      photograph.color(x, y) = {static_cast<std::uint8_t>(std::lround(255 * value)), 0, 200};
    }
  }
  return photograph;
}

TEST(Lenses, PixelsLieWhereTheirRaysAreSeen) {
  for (const Lens& lens : {brown(-0.2), brown(0.1, 0.01), measured(0.15), measured(-0.15)}) {
    const auto pixel = pixelOf(lens, rayOf(lens, 71, 9));
    ASSERT_TRUE(pixel.has_value());
    EXPECT_NEAR(pixel->x(), 71, 1e-9);
    EXPECT_NEAR(pixel->y(), 9, 1e-9);
  }
}

TEST(Lenses, NothingIsSeenBeyondWhereTheyFoldBack) {
  EXPECT_FALSE(pixelOf(measured(-0.5), {0.6, 0}).has_value());  // 2/3 · 1/√1.5 = 0.544
  EXPECT_TRUE(pixelOf(measured(-0.5), {0.54, 0}).has_value());
  EXPECT_FALSE(pixelOf(brown(-1), {0.6, 0}).has_value());
}

TEST(Lenses, UndistortedPicturesShowWhatAPinholeSees) {
  for (const Lens& lens : {brown(-0.2), brown(0.15, 0.01), measured(0.15), measured(-0.15)}) {
    Photograph photograph = photographThrough(lens);
    undistort(photograph, lens);
    EXPECT_TRUE(photograph.mask.empty());
    const Pinhole& c = photograph.camera;
    EXPECT_FALSE(isDistorted(c));
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 80; ++x) {
        const double value = brightnessAt({(x - c.cx) / c.fx, (y - c.cy) / c.fy});
        ASSERT_NEAR(photograph.brightness(x, y), value, 1e-3) << x << ", " << y;
        ASSERT_NEAR(photograph.color(x, y)[0], 255 * value, 1.1);
      }
    }
    EXPECT_EQ(photograph.color(40, 30)[2], 200);
  }
}

TEST(Lenses, CamerasZoomInOnlyAsFarAsThePictureReaches) {
  EXPECT_EQ(withoutDistortion(brown(0)), brown(0).camera);
  EXPECT_EQ(withoutDistortion(brown(-0.2)).fx, 70);
  const Lens wide = brown(0.15);
  const Pinhole camera = withoutDistortion(wide);
  EXPECT_GT(camera.fx, 71);
  EXPECT_LT(camera.fx, 80);
  EXPECT_NEAR(camera.fy / camera.fx, 72.0 / 70, 1e-12);
  // The corner furthest from the middle is at the picture's rim.
  const auto corner = pixelOf(wide, {(79 - camera.cx) / camera.fx, (0 - camera.cy) / camera.fy});
  EXPECT_LE(corner->x(), 79.001);
  EXPECT_GE(corner->x(), 78.8);
}

TEST(Lenses, WhatLiesOutsideThePictureIsMasked) {
  const Lens lens = brown(4);
  Photograph photograph = photographThrough(brown(0));
  photograph.camera = withoutDistortion(lens);
  EXPECT_NEAR(photograph.camera.fx, 105, 1e-9);
  undistort(photograph, lens);
  ASSERT_FALSE(photograph.mask.empty());
  EXPECT_EQ(photograph.mask(0, 0), 0);
  EXPECT_EQ(photograph.brightness(0, 0), 0);
  EXPECT_EQ(photograph.color(0, 0), (Rgb8{0, 0, 0}));
  EXPECT_EQ(photograph.mask(40, 30), 255);
}

TEST(Lenses, MasksMoveWithTheirPixels) {
  const Lens lens = brown(-0.2);
  Photograph photograph = photographThrough(lens);
  photograph.mask = Image<std::uint8_t>(80, 60, std::uint8_t{255});
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 20; ++x) photograph.mask(x, y) = 0;
  undistort(photograph, lens);
  const Pinhole& c = photograph.camera;
  for (int x = 0; x < 80; ++x) {
    const auto source = pixelOf(lens, {(x - c.cx) / c.fx, 0});
    EXPECT_EQ(photograph.mask(x, 30), source->x() < 19.5 ? 0 : 255) << x;
  }
}

}  // namespace
}  // namespace vdbfuse
