// SPDX-License-Identifier: Apache-2.0
#include "fusion/depth_tiles.h"

#include <limits>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

DepthTiles::DepthTiles(const Image<float>& depth)
    : least((depth.width() + kSide - 1) / kSide, (depth.height() + kSide - 1) / kSide), most(least) {
  const int width = depth.width(), height = depth.height();
  parallelFor(static_cast<std::size_t>(least.height()), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> nearest(static_cast<std::size_t>(width)), furthest(nearest);
    for (auto tile = static_cast<int>(begin); tile < static_cast<int>(end); ++tile) {
      std::fill(nearest.begin(), nearest.end(), kInfinity), std::fill(furthest.begin(), furthest.end(), 0.0f);
      for (int y = tile * kSide; y < std::min(height, (tile + 1) * kSide); ++y) {
        const float* row = depth.row(y);
        float *low = nearest.data(), *high = furthest.data();
        for (int x = 0; x < width; ++x) {
          const float d = row[x], measured = d > 0 ? d : kInfinity;
          low[x] = measured < low[x] ? measured : low[x];
          high[x] = d > high[x] ? d : high[x];
        }
      }
      for (int x = 0; x < least.width(); ++x) {
        const auto from = x * kSide, to = std::min(width, from + kSide);
        least(x, tile) = *std::min_element(nearest.begin() + from, nearest.begin() + to);
        most(x, tile) = *std::max_element(furthest.begin() + from, furthest.begin() + to);
      }
    }
  });
}

DepthTiles::Range DepthTiles::over(float x0, float y0, float x1, float y1) const {
  const auto tile = [](float pixel, int last) {
    return static_cast<int>(std::clamp(pixel / kSide, 0.0f, static_cast<float>(last)));
  };
  Range range{kInfinity, 0.0f};
  const int left = tile(x0, least.width() - 1), right = tile(x1, least.width() - 1);
  for (int y = tile(y0, least.height() - 1), last = tile(y1, least.height() - 1); y <= last; ++y) {
    for (int x = left; x <= right; ++x) {
      range.least = std::min(range.least, least(x, y));
      range.most = std::max(range.most, most(x, y));
    }
  }
  return range;
}

}  // namespace vdbfuse
