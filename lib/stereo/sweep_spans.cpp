// SPDX-License-Identifier: Apache-2.0
#include "stereo/sweep_spans.h"

namespace vdbfuse::stereo {
namespace {

constexpr std::size_t kLanes = kVectorLanes;

Span wholeVectors(std::size_t begin, std::size_t end) {
  return {begin / kLanes * kLanes, (end + kLanes - 1) / kLanes * kLanes};
}

Span windowsOf(const SweepTile& tile, int y) {
  const float* first = tile.inverse_spread.data() + tile.at(0, y);
  const float* last = first + tile.width;
  const auto is_window = [](float inverse_spread) { return inverse_spread > 0; };
  const float* begin = std::find_if(first, last, is_window);
  if (begin == last) return {};
  const float* end = last;
  while (!is_window(end[-1])) --end;
  return wholeVectors(static_cast<std::size_t>(begin - first), static_cast<std::size_t>(end - first));
}

Span hull(const Span& a, const Span& b) {
  if (a.isEmpty()) return b;
  if (b.isEmpty()) return a;
  return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

}  // namespace

SweepSpans sweepSpans(const SweepTile& tile) {
  const auto margin = static_cast<std::size_t>(2 * tile.radius),
             stride = static_cast<std::size_t>(tile.stride);
  SweepSpans spans;
  for (int y = 0; y < tile.height; ++y) spans.windows.push_back(windowsOf(tile, y));
  spans.pixels.resize(spans.windows.size() + margin);
  for (std::size_t y = 0; y < spans.windows.size(); ++y) {
    Span around = spans.windows[y];
    if (around.isEmpty()) continue;
    around = wholeVectors(around.begin, std::min(stride, around.end + margin));
    for (std::size_t k = 0; k <= margin; ++k) spans.pixels[y + k] = hull(spans.pixels[y + k], around);
  }
  return spans;
}

}  // namespace vdbfuse::stereo
