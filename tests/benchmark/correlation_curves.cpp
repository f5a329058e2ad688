// SPDX-License-Identifier: Apache-2.0
#include "correlation_curves.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbfuse::benchmark {
namespace {

using Eigen::Vector3d;

constexpr int kReach = 3;
constexpr int kWindow = (2 * kReach + 1) * (2 * kReach + 1);
using Window = std::array<double, kWindow>;
using Curve = std::vector<double>;

// Mean 0 and norm 1; nothing where there is no contrast.
std::optional<Window> normalised(Window window) {
  constexpr double kPlain = 1e-3;
  double mean = 0, squares = 0;
  for (const double v : window) mean += v / kWindow;
  for (double& v : window) v -= mean, squares += v * v;
  if (squares < kPlain * kPlain * kWindow) return std::nullopt;
  for (double& v : window) v /= std::sqrt(squares);
  return window;
}

std::optional<double> interpolated(const Image<float>& image, double x, double y) {
  if (!(x >= 0 && y >= 0 && x < image.width() - 1 && y < image.height() - 1)) return std::nullopt;
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const double u = x - x0, v = y - y0;
  return (1 - v) * ((1 - u) * image(x0, y0) + u * image(x0 + 1, y0)) +
         v * ((1 - u) * image(x0, y0 + 1) + u * image(x0 + 1, y0 + 1));
}

// One value for each offset of the window, row by row.
template <class Value>
std::optional<Window> windowOf(const Value& value) {
  Window window;
  for (int i = 0; i < kWindow; ++i) {
    const std::optional<double> v = value(i % (2 * kReach + 1) - kReach, i / (2 * kReach + 1) - kReach);
    if (!v) return std::nullopt;
    window[static_cast<std::size_t>(i)] = *v;
  }
  return normalised(window);
}

struct Pixel {
  const Photograph& reference;
  int x, y;

  std::optional<PixelDepth> seenIn(const Photograph& partner, double column, double row, double depth) const {
    const Vector3d point = reference.world_from_camera * unproject(reference.camera, column, row, depth);
    return project(partner.camera, partner.world_from_camera.inverse(Eigen::Isometry) * point);
  }
};

// Inverse depths from far to near.
std::vector<double> inverseDepths(const Pixel& pixel, const std::vector<Photograph>& partners) {
  const DepthInterval depth = *pixel.reference.depth;
  double longest = 1;
  for (const Photograph& partner : partners) {
    const auto near = pixel.seenIn(partner, pixel.x, pixel.y, depth.near);
    const auto far = pixel.seenIn(partner, pixel.x, pixel.y, depth.far);
    if (near && far) longest = std::max(longest, std::hypot(near->x - far->x, near->y - far->y));
  }
  const auto steps = static_cast<std::size_t>(2 * longest) + 1;
  std::vector<double> result(steps + 1);
  for (std::size_t k = 0; k <= steps; ++k)
    result[k] = 1 / depth.far +
                (1 / depth.near - 1 / depth.far) * static_cast<double>(k) / static_cast<double>(steps);
  return result;
}

// Correlations at the inverse depths; 0 where the window leaves the picture or has no contrast.
Curve correlations(const Pixel& pixel, const Window& window, const Photograph& partner,
                   const std::vector<double>& inverse_depths) {
  Curve curve;
  for (const double w : inverse_depths) {
    const auto other = windowOf([&](int u, int v) -> std::optional<double> {
      const auto seen = pixel.seenIn(partner, pixel.x + u, pixel.y + v, 1 / w);
      return seen ? interpolated(partner.brightness, seen->x, seen->y) : std::nullopt;
    });
    double sum = 0;
    for (std::size_t i = 0; other && i < window.size(); ++i) sum += window[i] * (*other)[i];
    curve.push_back(sum);
  }
  return curve;
}

// The depth of the largest value, between the samples by a parabola; 0 when none is positive.
double bestDepth(const Curve& curve, const std::vector<double>& inverse_depths) {
  const auto best = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
  if (curve[best] <= 0) return 0;
  if (best == 0 || best + 1 == curve.size()) return 1 / inverse_depths[best];
  const double before = curve[best - 1], after = curve[best + 1];
  const double bend = before - 2 * curve[best] + after;
  const double shift = bend < 0 ? 0.5 * (before - after) / bend : 0;
  return 1 / (inverse_depths[best] + shift * (inverse_depths[1] - inverse_depths[0]));
}

// Adds a Gaussian of the height of each maximum above the threshold.
void vote(const Curve& curve, Curve& votes) {
  constexpr double kThreshold = 0.5, kWidth = 2;
  constexpr int kFar = 8;
  for (int k = 1; k + 1 < static_cast<int>(curve.size()); ++k) {
    if (curve[k] <= kThreshold || curve[k] < curve[k - 1] || curve[k] <= curve[k + 1]) continue;
    const double bend = curve[k - 1] - 2 * curve[k] + curve[k + 1];
    const double at = k + 0.5 * (curve[k - 1] - curve[k + 1]) / bend;
    for (int i = std::max(0, k - kFar); i <= std::min(static_cast<int>(curve.size()) - 1, k + kFar); ++i)
      votes[i] += curve[k] * std::exp(-0.5 * (i - at) * (i - at) / (kWidth * kWidth));
  }
}

}  // namespace

CurveDepths depthsFromCurves(const Photograph& reference, const std::vector<Photograph>& partners, int x,
                             int y) {
  const auto window =
      windowOf([&](int u, int v) { return interpolated(reference.brightness, x + u, y + v); });
  if (!window) return {};
  const Pixel pixel{reference, x, y};
  const std::vector<double> inverse_depths = inverseDepths(pixel, partners);
  Curve sum(inverse_depths.size()), votes(inverse_depths.size());
  for (const Photograph& partner : partners) {
    const Curve curve = correlations(pixel, *window, partner, inverse_depths);
    std::transform(curve.begin(), curve.end(), sum.begin(), sum.begin(), std::plus<>());
    vote(curve, votes);
  }
  return {bestDepth(sum, inverse_depths), bestDepth(votes, inverse_depths)};
}

}  // namespace vdbfuse::benchmark
