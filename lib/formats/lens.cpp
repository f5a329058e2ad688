// SPDX-License-Identifier: Apache-2.0
#include "formats/lens.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vdbfuse/base/rows.h"
#include "vdbfuse/geometry/distortion.h"

namespace vdbfuse {
namespace {

// The ray of the picture with (1 + k·r²)·ray = `ideal`, by Newton's method on its length.
std::optional<Eigen::Vector2d> measuredRay(double k, const Eigen::Vector2d& ideal) {
  const double length = ideal.norm();
  // From r = 1/√(−3k) on, the ideal length falls again: 2/3 of that r is the longest.
  if (k < 0 && length >= 2.0 / 3.0 / std::sqrt(-3 * k)) return std::nullopt;
  if (length == 0) return ideal;
  double r = length;
  if (k < 0) r = std::min(r, 1 / std::sqrt(-3 * k) * 0.999);
  for (int iteration = 0; iteration < 50; ++iteration) {
    const double step = (r + k * r * r * r - length) / (1 + 3 * k * r * r);
    r = std::max(r - step, 0.0);
    if (std::abs(step) <= 1e-14 * length) break;
  }
  return ideal * (r / length);
}

bool isInside(const Pinhole& camera, const std::optional<Eigen::Vector2d>& pixel) {
  constexpr double kTolerance = 1e-6;
  return pixel && pixel->x() >= -kTolerance && pixel->y() >= -kTolerance &&
         pixel->x() <= camera.width - 1 + kTolerance && pixel->y() <= camera.height - 1 + kTolerance;
}

std::optional<Eigen::Vector2d> sourceOf(const Lens& lens, const Pinhole& target, int x, int y) {
  return pixelOf(lens, {(x - target.cx) / target.fx, (y - target.cy) / target.fy});
}

Pinhole zoomed(const Lens& lens, double factor) {
  Pinhole camera = lens.camera;
  camera.distortion = {};
  camera.fx *= factor, camera.fy *= factor;
  return camera;
}

// Distortion grows with the distance from the middle: what holds for the rim holds for all pixels.
bool showsWholeRim(const Lens& lens, const Pinhole& target) {
  const auto is_shown = [&](int x, int y) { return isInside(lens.camera, sourceOf(lens, target, x, y)); };
  for (int x = 0; x < target.width; ++x)
    if (!is_shown(x, 0) || !is_shown(x, target.height - 1)) return false;
  for (int y = 0; y < target.height; ++y)
    if (!is_shown(0, y) || !is_shown(target.width - 1, y)) return false;
  return true;
}

// The four pixels around a position in the picture, and their weights.
struct Footing {
  int x0, y0, x1, y1;
  double u, v;

  Footing(const Eigen::Vector2d& at, int width, int height) {
    const double x = std::clamp(at.x(), 0.0, width - 1.0), y = std::clamp(at.y(), 0.0, height - 1.0);
    x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
    u = x - x0, v = y - y0;
  }
  template <class Value>
  double mix(const Value& value) const {
    return (1 - v) * ((1 - u) * value(x0, y0) + u * value(x1, y0)) +
           v * ((1 - u) * value(x0, y1) + u * value(x1, y1));
  }
};

Rgb8 mixedColor(const Image<Rgb8>& color, const Footing& footing) {
  Rgb8 mixed{};
  for (std::size_t k = 0; k < mixed.size(); ++k) {
    const double value = footing.mix([&](int x, int y) -> double { return color(x, y)[k]; });
    mixed[k] = static_cast<std::uint8_t>(std::lround(value));
  }
  return mixed;
}

}  // namespace

bool isDistorted(const Lens& lens) { return isDistorted(lens.camera) || lens.measured_radial != 0; }

std::optional<Eigen::Vector2d> pixelOf(const Lens& lens, const Eigen::Vector2d& ray) {
  std::optional<Eigen::Vector2d> seen = ray;
  if (lens.measured_radial != 0) seen = measuredRay(lens.measured_radial, ray);
  if (isDistorted(lens.camera)) seen = distort(lens.camera, ray);
  if (!seen) return std::nullopt;
  const Pinhole& c = lens.camera;
  return Eigen::Vector2d(c.fx * seen->x() + c.cx, c.fy * seen->y() + c.cy);
}

Pinhole withoutDistortion(const Lens& lens) {
  double low = 1, high = 1.5;
  if (!isDistorted(lens) || showsWholeRim(lens, zoomed(lens, low))) return zoomed(lens, low);
  if (!showsWholeRim(lens, zoomed(lens, high))) return zoomed(lens, high);
  for (int i = 0; i < 10; ++i) {
    const double middle = 0.5 * (low + high);
    (showsWholeRim(lens, zoomed(lens, middle)) ? high : low) = middle;
  }
  return zoomed(lens, high);
}

void undistort(Photograph& photograph, const Lens& lens) {
  const Pinhole& target = photograph.camera;
  const int width = target.width, height = target.height;
  const bool has_color = !photograph.color.empty(), has_mask = !photograph.mask.empty();
  Image<float> brightness(width, height, 0.0F);
  Image<Rgb8> color(has_color ? width : 0, has_color ? height : 0);
  Image<std::uint8_t> mask(width, height, std::uint8_t{0});
  constexpr std::size_t kRows = 16;
  forEachRow(height, kRows, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::optional<Eigen::Vector2d> at = sourceOf(lens, target, x, y);
      if (!isInside(lens.camera, at)) continue;
      const Footing footing(*at, width, height);
      brightness(x, y) = static_cast<float>(footing.mix(photograph.brightness));
      if (has_color) color(x, y) = mixedColor(photograph.color, footing);
      mask(x, y) = has_mask ? photograph.mask(footing.u < 0.5 ? footing.x0 : footing.x1,
                                              footing.v < 0.5 ? footing.y0 : footing.y1)
                            : 255;
    }
  });
  photograph.brightness = std::move(brightness);
  photograph.color = std::move(color);
  const bool shows_all = std::all_of(mask.begin(), mask.end(), [](std::uint8_t m) { return m != 0; });
  if (has_mask || !shows_all) photograph.mask = std::move(mask);
}

}  // namespace vdbfuse
