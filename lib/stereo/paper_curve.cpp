// SPDX-License-Identifier: Apache-2.0
#include "stereo/paper_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stereo/matching_constants.h"

namespace vdbfuse::stereo::paper {
namespace {

bool isMasked(const Photograph& photograph, int x, int y) {
  return !photograph.mask.empty() && photograph.mask(x, y) == 0;
}

// Takes the mean away and divides by the norm; false, and undefined values, where there is no texture.
bool normalise(std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double sum = 0, squares = 0;
  for (const double value : values) sum += value;
  for (double& value : values) value -= sum / count, squares += value * value;
  if (squares < kLeastDeviation * kLeastDeviation * count) return false;
  const double scale = 1 / std::sqrt(squares);
  for (double& value : values) value *= scale;
  return true;
}

// Brightness between the pixels; NaN beyond the outermost pixel centres or outside the mask.
double brightnessAt(const Photograph& photograph, const Eigen::Vector3d& homogeneous) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  if (!(homogeneous.z() > 0)) return kNothing;
  const double inverse = 1 / homogeneous.z();
  const double x = homogeneous.x() * inverse, y = homogeneous.y() * inverse;
  const Image<float>& image = photograph.brightness;
  if (!(x >= 0 && y >= 0 && x <= image.width() - 1 && y <= image.height() - 1)) return kNothing;
  if (isMasked(photograph, static_cast<int>(x + 0.5), static_cast<int>(y + 0.5))) return kNothing;
  const int left = std::min(static_cast<int>(x), image.width() - 2);
  const int top = std::min(static_cast<int>(y), image.height() - 2);
  const auto between = [&](int row) {
    const double first = double{image(left, row)}, second = double{image(left + 1, row)};
    return first + (x - left) * (second - first);
  };
  return between(top) + (y - top) * (between(top + 1) - between(top));
}

// The images of the window's pixels at infinite depth, from where they set out along their rays.
std::vector<Eigen::Vector3d> imagesAtInfinity(const Window& window, const RayImage& ray) {
  std::vector<Eigen::Vector3d> images;
  for (int y = window.y - window.radius; y <= window.y + window.radius; ++y)
    for (int x = window.x - window.radius; x <= window.x + window.radius; ++x)
      images.push_back(ray.at(x, y, 0));
  return images;
}

// `values` is memory for the partner's window.
double correlation(const Window& window, const std::vector<Eigen::Vector3d>& at_infinity,
                   const Eigen::Vector3d& motion, const Photograph& partner, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = brightnessAt(partner, at_infinity[i] + motion);
    if (std::isnan(values[i])) return kNoScore;
  }
  if (!normalise(values)) return kNoScore;
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += window.values[i] * values[i];
  return std::clamp(sum, -1.0, 1.0);
}

}  // namespace

std::optional<Window> windowAt(const Photograph& photograph, int x, int y, int radius) {
  Window window{x, y, radius, {}};
  for (int v = y - radius; v <= y + radius; ++v)
    for (int u = x - radius; u <= x + radius; ++u) {
      if (!photograph.brightness.contains(u, v) || isMasked(photograph, u, v)) return std::nullopt;
      window.values.push_back(double{photograph.brightness(u, v)});
    }
  if (!normalise(window.values)) return std::nullopt;
  return window;
}

std::vector<double> correlationCurve(const Window& window, const Photograph& partner, const RayImage& ray,
                                     const RaySteps& steps) {
  const std::vector<Eigen::Vector3d> at_infinity = imagesAtInfinity(window, ray);
  std::vector<double> curve, values(window.values.size());
  for (int k = 0; k < steps.count; ++k)
    curve.push_back(correlation(window, at_infinity, steps.inverseDepth(k) * ray.b, partner, values));
  return curve;
}

}  // namespace vdbfuse::stereo::paper
