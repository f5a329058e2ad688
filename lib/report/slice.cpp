// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/slice.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/report/color_map.h"

namespace vdbfuse {
namespace {

constexpr Rgb8 kUnknown{128, 128, 128}, kLine{0, 0, 0};

// The axes that run to the right and upwards in the picture.
struct PictureAxes {
  int right, up;
};
constexpr PictureAxes kAxes[] = {{1, 2}, {0, 2}, {0, 1}};

float quantile(std::vector<float>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Range {
  double low, high;
};

Range colorRange(const Image<float>& image, const SliceOptions& options) {
  constexpr double kTail = 0.02;
  const bool is_signed = options.colors == SliceColors::Signed;
  if (is_signed && options.high > 0) return {-options.high, options.high};
  if (!is_signed && options.high > options.low) return {options.low, options.high};
  std::vector<float> values;
  for (const float v : image)
    if (std::isfinite(v)) values.push_back(is_signed ? std::abs(v) : v);
  if (values.empty()) return {0, 1};
  const double high = quantile(values, 1 - kTail);
  return is_signed ? Range{-high, high} : Range{quantile(values, kTail), high};
}

// Position of a value in the range, in [−1, 1] or [0, 1]; the middle where the range is empty.
Rgb8 colorOf(double value, const Range& range, SliceColors colors) {
  if (!std::isfinite(value)) return kUnknown;
  const double extent = range.high - range.low;
  const double position = extent > 0 ? (value - range.low) / extent : 0.5;
  // The colour map runs from blue to red, and outside, where the field is positive, is blue.
  return colors == SliceColors::Signed ? divergingColor(1 - 2 * position) : sequentialColor(position);
}

bool changesSign(float a, float b) { return std::isfinite(a) && std::isfinite(b) && (a < 0) != (b < 0); }

void drawZeroLine(const Image<float>& values, Image<Rgb8>& picture) {
  for (int y = 0; y < values.height(); ++y)
    for (int x = 0; x < values.width(); ++x) {
      const bool right = x + 1 < values.width() && changesSign(values(x, y), values(x + 1, y));
      const bool below = y + 1 < values.height() && changesSign(values(x, y), values(x, y + 1));
      if (right || below) picture(x, y) = kLine;
    }
}

}  // namespace

Image<float> sampleSlice(const ScalarField& field, const Box& box, const SlicePlane& plane, int longest) {
  if (plane.axis < 0 || plane.axis > 2) throw InvalidArgument("plane", "the axis must be 0, 1 or 2");
  if (longest <= 0) throw InvalidArgument("longest", "must be positive");
  if (box.isEmpty()) throw InvalidArgument("box", "is empty");
  const auto [right, up] = kAxes[plane.axis];
  const Eigen::Vector3d extent = box.sizes();
  const double pixel = std::max(extent[right], extent[up]) / longest;
  const auto pixels = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length / pixel)));
  };
  Image<float> values(pixels(extent[right]), pixels(extent[up]));
  parallelFor(static_cast<std::size_t>(values.height()), 8, [&](std::size_t begin, std::size_t end) {
    Eigen::Vector3d point;
    point[plane.axis] = plane.value;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < values.width(); ++x) {
        point[kAxes[plane.axis].right] = box.min()[kAxes[plane.axis].right] + (x + 0.5) * pixel;
        point[kAxes[plane.axis].up] = box.max()[kAxes[plane.axis].up] - (y + 0.5) * pixel;
        values(x, y) = static_cast<float>(field(point));
      }
  });
  return values;
}

Image<Rgb8> drawSlice(const Image<float>& values, const SliceOptions& options) {
  const Range range = colorRange(values, options);
  Image<Rgb8> picture(values.width(), values.height());
  for (int y = 0; y < values.height(); ++y)
    for (int x = 0; x < values.width(); ++x) picture(x, y) = colorOf(values(x, y), range, options.colors);
  if (options.colors == SliceColors::Signed) drawZeroLine(values, picture);
  return picture;
}

}  // namespace vdbfuse
