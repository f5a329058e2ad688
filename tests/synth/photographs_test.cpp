// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace vdbfuse {
namespace {

using Eigen::Vector3d;

const Scene& scene(const std::string& name) {
  static const Scene sphere = makeScene("sphere", {1.0 / 100}), figure = makeScene("figure", {1.0 / 160});
  return name == "sphere" ? sphere : figure;
}

// Exact depths, pictures without noise and highlights.
SynthOptions matt(int views = 1) {
  SynthOptions options;
  options.views = views, options.width = 160, options.height = 120, options.arc = Arc::Ring;
  options.noise_scale = 0, options.confidence = ConfidenceKind::None;
  options.photographs = PhotographOptions{.noise = 0, .gloss = 0};
  return options;
}

struct Moments {
  std::vector<double> values;
  double mean() const {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  }
  double deviation() const {
    double squares = 0;
    for (const double v : values) squares += (v - mean()) * (v - mean());
    return std::sqrt(squares / static_cast<double>(values.size()));
  }
};

double interpolated(const Image<float>& image, double x, double y) {
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const double u = x - x0, v = y - y0;
  return (1 - v) * ((1 - u) * image(x0, y0) + u * image(x0 + 1, y0)) +
         v * ((1 - u) * image(x0, y0 + 1) + u * image(x0 + 1, y0 + 1));
}

// Brightness of the points that view `a` sees well inside the object, and its differences from where view `b`
// shows them, moved by `shift` pixels.
std::pair<Moments, Moments> compared(const SyntheticView& a, const SyntheticView& b, double shift) {
  const Image<float> of_a = brightnessOf(a.view.map.color), of_b = brightnessOf(b.view.map.color);
  const RigidTransform b_from_world = b.view.world_from_camera.inverse();
  std::pair<Moments, Moments> result;
  for (int y = 0; y < of_a.height(); ++y)
    for (int x = 0; x < of_a.width(); ++x) {
      if (!a.object(x, y)) continue;
      const Vector3d point = worldPoint(a.view, x, y);
      const auto facing = [&](const SyntheticView& view) {
        return point.normalized().dot((view.view.world_from_camera.translation() - point).normalized());
      };
      if (facing(a) < 0.6 || facing(b) < 0.6) continue;
      const auto seen = project(b.view.projection, b_from_world * point);
      result.first.values.push_back(of_a(x, y));
      result.second.values.push_back(std::abs(of_a(x, y) - interpolated(of_b, seen->x + shift, seen->y)));
    }
  return result;
}

TEST(Photographs, TheTextureIsTheSameFromTwoViewsAtExactlyTheTruePlace) {
  const SyntheticScan scan(scene("sphere"), matt(36));
  const SyntheticView a = scan.render(0), b = scan.render(1);
  const auto [brightness, off] = compared(a, b, 0);
  ASSERT_GT(off.values.size(), 1500u);
  EXPECT_GT(brightness.deviation(), 0.08);
  EXPECT_LT(off.mean(), 0.2 * brightness.deviation());
  for (const double shift : {-0.4, 0.4}) EXPECT_GT(compared(a, b, shift).second.mean(), 1.4 * off.mean());
}

TEST(Photographs, ExposureAndBiasChangeAPictureByAFactorAndASummandOfItsOwn) {
  SynthOptions options = matt(4);
  const SyntheticScan plain(scene("sphere"), options);
  options.photographs->gain = 1.5, options.photographs->bias = 8;
  const SyntheticScan exposed(scene("sphere"), options);
  std::vector<double> gains;
  for (std::size_t i = 0; i < 4; ++i) {
    const Image<Rgb8> from = plain.photographs().load(i).color, to = exposed.photographs().load(i).color;
    const int bias = to(0, 0)[0];  // before the black background, 0 where it is negative
    const int x = 80, y = 60;
    const double gain = (to(x, y)[0] - bias) / static_cast<double>(from(x, y)[0]);
    gains.push_back(gain);
    EXPECT_LE(bias, 8);
    EXPECT_GT(gain, 0.6);
    EXPECT_LT(gain, 1.55);
    if (bias == 0) continue;
    for (std::size_t p = 0; p < from.size(); ++p)
      EXPECT_NEAR(std::min(255.0, gain * from.data()[p][1] + bias), to.data()[p][1], 4);
  }
  EXPECT_GT(*std::max_element(gains.begin(), gains.end()) - *std::min_element(gains.begin(), gains.end()),
            0.1);
}

TEST(Photographs, TheNoiseHasTheScaleThatWasAskedFor) {
  SynthOptions options = matt();
  const SyntheticView clean = SyntheticScan(scene("sphere"), options).render(0);
  options.photographs->noise = 3;
  const SyntheticView noisy = SyntheticScan(scene("sphere"), options).render(0);
  Moments difference;
  for (std::size_t i = 0; i < clean.object.size(); ++i) {
    const int level = clean.view.map.color.data()[i][1];
    if (level > 20 && level < 235) difference.values.push_back(noisy.view.map.color.data()[i][1] - level);
  }
  ASSERT_GT(difference.values.size(), 2000u);
  EXPECT_NEAR(difference.mean(), 0, 0.2);
  EXPECT_NEAR(difference.deviation(), 3, 0.15);
}

// Deviation, in grey levels, of the picture in the 7×7 window around a pixel that sees the object everywhere
// in it; nothing elsewhere.
std::optional<double> contrast(const SyntheticView& view, const Image<float>& brightness, int x, int y) {
  Moments window;
  for (int v = y - 3; v <= y + 3; ++v)
    for (int u = x - 3; u <= x + 3; ++u) {
      if (!view.object.contains(u, v) || !view.object(u, v)) return std::nullopt;
      window.values.push_back(255 * brightness(u, v));
    }
  return window.deviation();
}

TEST(Photographs, AreTexturedEverywhereOnTheObjectAndHardlySaturated) {
  SynthOptions options = matt(4);
  options.width = 320, options.height = 240;
  options.photographs = PhotographOptions{.noise = 0};
  for (const SyntheticView& view : renderAll(SyntheticScan(scene("figure"), options))) {
    const Image<float> brightness = brightnessOf(view.view.map.color);
    int windows = 0, plain = 0, saturated = 0, seen = 0;
    for (int y = 0; y < options.height; ++y)
      for (int x = 0; x < options.width; ++x) {
        const Rgb8& color = view.view.map.color(x, y);
        seen += view.object(x, y);
        if (view.object(x, y) && *std::max_element(color.begin(), color.end()) == 255) ++saturated;
        const std::optional<double> deviation = contrast(view, brightness, x, y);
        if (deviation) ++windows, plain += *deviation < 4 ? 1 : 0;
      }
    ASSERT_GT(windows, 3000);
    EXPECT_LT(plain, 0.01 * windows);
    EXPECT_LT(saturated, 0.01 * seen);
  }
}

TEST(Photographs, TheInsideOfTheCavityIsLitAndTextured) {
  SynthOptions options = matt();
  options.width = 320, options.height = 240;
  const SyntheticScan scan(scene("figure"), options);
  const auto cavity = std::get<Box>(scan.scene().regions.front().shape);
  const SyntheticView view = scan.render(0);
  const Image<float> brightness = brightnessOf(view.view.map.color);
  Moments inside;
  for (int y = 0; y < options.height; ++y)
    for (int x = 0; x < options.width; ++x)
      if (view.object(x, y) && cavity.exteriorDistance(worldPoint(view.view, x, y)) < 0.02)
        if (worldPoint(view.view, x, y).y() > cavity.center().y())
          inside.values.push_back(255 * brightness(x, y));
  ASSERT_GT(inside.values.size(), 100u);
  EXPECT_GT(inside.mean(), 40);
  EXPECT_GT(inside.deviation(), 10);
}

TEST(Photographs, LightComesFromAboveTheFront) {
  const SyntheticView view = SyntheticScan(scene("sphere"), matt(1)).render(0);
  const Image<float> brightness = brightnessOf(view.view.map.color);
  Moments above, below;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x)
      if (view.object(x, y)) (y < 60 ? above : below).values.push_back(brightness(x, y));
  EXPECT_GT(above.mean(), 1.2 * below.mean());
}

TEST(Photographs, TheBackgroundIsBlackOrAWallWithTexture) {
  SynthOptions options = matt();
  for (const Background background : {Background::None, Background::Wall}) {
    options.background = background;
    const SyntheticView view = SyntheticScan(scene("sphere"), options).render(0);
    Moments levels;
    for (int y = 0; y < 120; ++y)
      for (int x = 0; x < 30; ++x) levels.values.push_back(view.view.map.color(x, y)[1]);
    EXPECT_EQ(levels.mean() > 0, background == Background::Wall);
    EXPECT_EQ(levels.deviation() > 15, background == Background::Wall);
  }
}

TEST(Photographs, AreThePicturesOfTheViewsWithTheirCamerasAndOutlineWhenAsked) {
  SynthOptions options = matt(3);
  options.photographs = PhotographOptions{.gain = 1.2, .bias = 4, .noise = 2};
  const SyntheticScan scan(scene("sphere"), options);
  const SyntheticView view = scan.render(2);
  const Photograph photograph = scan.photographs().load(2);
  EXPECT_EQ(photograph.name, view.view.name);
  EXPECT_EQ(photograph.color, view.view.map.color);
  EXPECT_EQ(photograph.brightness, brightnessOf(photograph.color));
  EXPECT_TRUE(photograph.mask.empty());
  EXPECT_EQ(photograph.depth->near, depthRange(options).near);
  const Photograph outlined = scan.photographs(Silhouettes::True).load(2);
  for (std::size_t i = 0; i < view.object.size(); ++i)
    ASSERT_EQ(outlined.mask.data()[i] != 0, view.object.data()[i] != 0);
}

TEST(Photographs, AreTheSameForOneThreadAndTwoAndLeaveTheDepthsAsTheyWere) {
  SynthOptions options = matt(2);
  options.noise_scale = 0.001, options.photographs = PhotographOptions{.gain = 1.2};
  const auto render = [&](int threads) {
    const ThreadLimit limit(threads);
    return SyntheticScan(scene("sphere"), options).render(1);
  };
  const SyntheticView one = render(1), two = render(2);
  EXPECT_EQ(one.view.map.color, two.view.map.color);
  options.photographs.reset();
  const SyntheticView bare = render(1);
  EXPECT_TRUE(bare.view.map.color.empty());
  EXPECT_EQ(bare.view.map.depth, one.view.map.depth);
}

TEST(Photographs, ThereAreNoneUnlessAskedFor) {
  SynthOptions options = matt();
  options.photographs.reset();
  const SyntheticScan scan(scene("sphere"), options);
  try {
    scan.photographs();
    FAIL() << "accepted";
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "photographs: the scan takes none");
  }
}

TEST(Photographs, EverythingThatIsWrongWithTheirOptionsIsListed) {
  SynthOptions options;
  options.photographs = PhotographOptions{0.5, -1, std::nan(""), 2};
  EXPECT_THAT(
      validate(options),
      testing::ElementsAre("the gain must be at least 1", "the bias must not be negative",
                           "the noise of the image must not be negative", "the gloss must lie in [0, 1]"));
}

}  // namespace
}  // namespace vdbfuse
