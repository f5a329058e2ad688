// SPDX-License-Identifier: Apache-2.0
#include "stereo_preview.h"

#include <algorithm>
#include <vector>

#include "vdbfuse/report/color_map.h"

namespace vdbfuse::tool {
namespace {

struct Range {
  double low = 0, high = 0;
  double shareOf(double value) const { return high > low ? (value - low) / (high - low) : 0.5; }
};

// Of what is valid, without the outermost hundredths.
Range inverseDepths(const Image<float>& depth) {
  std::vector<double> values;
  for (const float d : depth)
    if (d != kInvalidDepth) values.push_back(1.0 / d);
  if (values.empty()) return {};
  const auto at = [&](std::size_t percent) {
    const auto place = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) * percent / 100);
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  return {at(1), at(99)};
}

}  // namespace

Image<Rgb8> stereoPreview(const View& view) {
  constexpr int kLongest = 1600;
  const DepthMap& map = view.map;
  const int step = (std::max(map.depth.width(), map.depth.height()) + kLongest - 1) / kLongest;
  const int width = map.depth.width() / step, height = map.depth.height() / step;
  const Range range = inverseDepths(map.depth);
  Image<Rgb8> preview(3 * width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int u = x * step, v = y * step;
      if (map.color.sameSize(map.depth)) preview(x, y) = map.color(u, v);
      const float depth = map.depth(u, v);
      if (depth == kInvalidDepth) continue;
      preview(width + x, y) = sequentialColor(range.shareOf(1.0 / static_cast<double>(depth)));
      preview(2 * width + x, y) = sequentialColor(static_cast<double>(map.confidence(u, v)));
    }
  }
  return preview;
}

}  // namespace vdbfuse::tool
