// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/measurement_weight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fusion/depth_edges.h"
#include "fusion/scenes.h"

namespace vdbfuse {
namespace {

constexpr WeightOptions kNone{false, false, false, false};

// A plane tilted by `angle` about the vertical, two away along the middle ray.
View tilted(double angle, int width = 61, int height = 41, const std::array<double, 5>& distortion = {}) {
  View view;
  view.name = "plane";
  const double focal = width;
  view.projection = Pinhole{width, height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1), distortion};
  view.map.depth = Image<float>(width, height);
  const Eigen::Vector3d normal(std::sin(angle), 0, std::cos(angle));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      view.map.depth(x, y) =
          static_cast<float>(2 * std::cos(angle) / normal.dot(unproject(view.projection, x, y, 1.0)));
  return view;
}

TEST(MeasurementWeights, NothingMeasuredWeighsNothingAndAllElseOneWithoutReasons) {
  View view = tilted(0);
  view.map.depth(3, 4) = kInvalidDepth;
  const Image<float> weights = measurementWeights(view, std::nullopt, 0.01, kNone);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 61; ++x) EXPECT_EQ(weights(x, y), x == 3 && y == 4 ? 0.0f : 1.0f);
}

TEST(MeasurementWeights, NoiseCountsByItsShareOfAVoxel) {
  const View view = tilted(0.6);
  const NoiseLaw law = NoiseLaw::structuredLight();
  WeightOptions options = kNone;
  options.noise = true;
  const Image<float> weights = measurementWeights(view, law, 0.01, options);
  for (const int x : {0, 17, 60}) {
    const double s = law.at(view.map.depth(x, 20));
    EXPECT_NEAR(weights(x, 20), 0.005 * 0.005 / (0.005 * 0.005 + s * s), 1e-5);
  }
  EXPECT_EQ(measurementWeights(view, std::nullopt, 0.01, options)(17, 20), 1.0f);
}

TEST(MeasurementWeights, IncidenceIsTheCosineOfTheRayWithTheNormal) {
  WeightOptions options = kNone;
  options.incidence = true;
  for (const double angle : {0.0, 0.5, 1.0, -1.0}) {
    const Eigen::Vector3d normal(std::sin(angle), 0, std::cos(angle));
    // Widths that vectors do not divide, and one narrower than they are.
    for (const int width : {61, 64, 7}) {
      const View view = tilted(angle, width);
      const Image<float> weights = measurementWeights(view, std::nullopt, 0.01, options);
      const int x = width / 2, y = 20;
      const double cosine = normal.dot(unproject(view.projection, x, y, 1.0).normalized());
      EXPECT_NEAR(weights(x, y), cosine, 2e-3) << angle << " " << width;
      if (std::abs(angle) < 0.6) {
        const double near_border = normal.dot(unproject(view.projection, 2, y, 1.0).normalized());
        EXPECT_NEAR(weights(2, y), near_border, 5e-3) << angle << " " << width;
      }
      EXPECT_EQ(weights(1, 20), 0.5f);  // unknown at the border
      EXPECT_EQ(weights(x, 0), 0.5f);
    }
  }
}

TEST(MeasurementWeights, OtherSensorsHaveAnIncidenceAsWell) {
  View view;
  view.projection = Orthographic{30, 30, 0, 0.01, 0, 0.01};
  view.map.depth = Image<float>(30, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 30; ++x) view.map.depth(x, y) = 2 + 0.01f * static_cast<float>(x);  // 45°
  WeightOptions options = kNone;
  options.incidence = true;
  EXPECT_NEAR(measurementWeights(view, std::nullopt, 0.01, options)(15, 15), std::sqrt(0.5), 1e-3);
}

TEST(MeasurementWeights, RiseFromDepthEdgesInwards) {
  View view = tilted(0);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 30; ++x) view.map.depth(x, y) = 1.0f;
  WeightOptions options = kNone;
  options.silhouette = true;
  const Image<float> weights = measurementWeights(view, std::nullopt, 0.01, options);
  const float expected[] = {1 / 7.0f, 3 / 7.0f, 5 / 7.0f, 1, 1};
  for (int step = 0; step < 5; ++step) {
    EXPECT_FLOAT_EQ(weights(29 - step, 20), expected[step]);
    EXPECT_FLOAT_EQ(weights(30 + step, 20), expected[step]);
  }
}

TEST(MeasurementWeights, SingleMissingPixelsMakeNoEdgeAndMissingPatchesDo) {
  View view = tilted(0);
  view.map.depth(10, 10) = view.map.depth(11, 10) = view.map.depth(14, 20) = kInvalidDepth;
  for (int y = 30; y < 33; ++y)
    for (int x = 30; x < 33; ++x) view.map.depth(x, y) = kInvalidDepth;
  WeightOptions options = kNone;
  options.silhouette = true;
  const Image<float> weights = measurementWeights(view, std::nullopt, 0.01, options);
  EXPECT_EQ(weights(12, 10), 1.0f);
  EXPECT_EQ(weights(14, 21), 1.0f);
  EXPECT_FLOAT_EQ(weights(33, 31), 1 / 7.0f);
  EXPECT_FLOAT_EQ(weights(29, 29), 1 / 7.0f);
  EXPECT_FLOAT_EQ(weights(35, 31), 5 / 7.0f);
  EXPECT_EQ(weights(36, 31), 1.0f);
}

TEST(MeasurementWeights, ALoneWrongDepthWeighsNothingAndALoneMeasurementCounts) {
  View view = tilted(0);
  view.map.depth(10, 10) = 1.2f, view.map.depth(0, 20) = 1.2f, view.map.depth(60, 40) = 1.2f;
  for (int y = 19; y < 22; ++y)
    for (int x = 29; x < 32; ++x)
      if (x != 30 || y != 20) view.map.depth(x, y) = kInvalidDepth;
  view.map.depth(40, 10) = view.map.depth(41, 10) = 1.2f;  // two agree
  WeightOptions options = kNone;
  options.silhouette = true;
  const Image<float> weights = measurementWeights(view, std::nullopt, 0.01, options);
  for (const auto& [x, y] : {std::pair(10, 10), std::pair(0, 20), std::pair(60, 40)})
    EXPECT_EQ(weights(x, y), 0.0f);
  EXPECT_FLOAT_EQ(weights(10, 11), 1 / 7.0f);
  EXPECT_EQ(weights(30, 20), 1.0f);
  EXPECT_FLOAT_EQ(weights(40, 10), 1 / 7.0f);
}

TEST(MeasurementWeights, ConfidenceCountsAsAProbability) {
  View view = tilted(0);
  view.map.confidence = Image<float>(61, 41, 0.25f);
  view.map.confidence(1, 1) = 7.0f, view.map.confidence(2, 1) = NAN, view.map.confidence(3, 1) = -2;
  WeightOptions options = kNone;
  options.confidence = true;
  const Image<float> weights = measurementWeights(view, std::nullopt, 0.01, options);
  EXPECT_EQ(weights(0, 0), 0.25f);
  EXPECT_EQ(weights(1, 1), 1.0f);
  EXPECT_EQ(weights(2, 1), 1.0f);
  EXPECT_EQ(weights(3, 1), 0.0f);
}

TEST(MeasurementWeights, OfAJudgedViewDoubtfulPixelsAreNotUsed) {
  JudgedViews judged = believe({tilted(0)}, test::sphereSensor(), 0.1);
  JudgedView& view = judged.views[0];
  view.outlier(5, 5) = 0.7f, view.outlier(6, 5) = 0.8f;
  view.incidence = Image<float>(61, 41, 0.9f);
  WeightOptions options = kNone;
  options.confidence = true;
  Image<float> weights = measurementWeights(view, judged.sensor.noise, 0.01, options);
  EXPECT_FLOAT_EQ(weights(0, 0), 0.9f);
  EXPECT_NEAR(weights(5, 5), 0.3f, 1e-6);
  EXPECT_EQ(weights(6, 5), 0.0f);
  options.incidence = true;
  EXPECT_FLOAT_EQ(measurementWeights(view, judged.sensor.noise, 0.01, options)(0, 0), 0.81f);
}

}  // namespace
}  // namespace vdbfuse
