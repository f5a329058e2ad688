// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/reduce.h"

#include <algorithm>
#include <vector>

namespace vdbfuse {
namespace {

// A block of pixels of the larger image; at the image's end it may be smaller than others.
struct Block {
  int left, top, right, bottom;
  int size() const { return (right - left) * (bottom - top); }
};

struct Pixel {
  float depth;
  int x, y;
};

// The pixel in the middle of the block where nothing is measured: its mask still counts.
Pixel middle(const Image<float>& depth, const Block& b) {
  const int x = (b.left + b.right - 1) / 2, y = (b.top + b.bottom - 1) / 2;
  return {depth(x, y), x, y};
}

Pixel median(const Image<float>& depth, const Block& b, std::vector<Pixel>& scratch) {
  scratch.clear();
  for (int y = b.top; y < b.bottom; ++y) {
    for (int x = b.left; x < b.right; ++x)
      if (depth(x, y) != kInvalidDepth) scratch.push_back({depth(x, y), x, y});
  }
  Pixel result = middle(depth, b);
  result.depth = kInvalidDepth;
  if (2 * static_cast<int>(scratch.size()) < b.size()) return result;
  const auto half = scratch.begin() + static_cast<std::ptrdiff_t>((scratch.size() - 1) / 2);
  // Equal depths in the order of the pixels, so that the choice does not depend on the library.
  std::nth_element(scratch.begin(), half, scratch.end(), [](const Pixel& a, const Pixel& c) {
    return a.depth != c.depth ? a.depth < c.depth : a.y != c.y ? a.y < c.y : a.x < c.x;
  });
  return *half;
}

}  // namespace

View reduced(View view, int factor, Reduction reduction) {
  if (factor == 1) return view;
  View result;
  result.name = std::move(view.name);
  result.world_from_camera = view.world_from_camera;
  result.projection = scaled(view.projection, 1.0 / factor);
  const DepthMap& from = view.map;
  DepthMap& to = result.map;
  const int width = imageWidth(result.projection), height = imageHeight(result.projection);
  to.depth = Image<float>(width, height);
  if (!from.confidence.empty()) to.confidence = Image<float>(width, height);
  if (!from.mask.empty()) to.mask = Image<std::uint8_t>(width, height);
  std::vector<Pixel> scratch;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Block block{
          std::min(x * factor, from.depth.width() - 1), std::min(y * factor, from.depth.height() - 1),
          std::min((x + 1) * factor, from.depth.width()), std::min((y + 1) * factor, from.depth.height())};
      const Pixel pixel =
          reduction == Reduction::Pick ? middle(from.depth, block) : median(from.depth, block, scratch);
      to.depth(x, y) = pixel.depth;
      if (!to.confidence.empty()) to.confidence(x, y) = from.confidence(pixel.x, pixel.y);
      if (!to.mask.empty()) to.mask(x, y) = from.mask(pixel.x, pixel.y);
    }
  }
  to.color = std::move(view.map.color);
  return result;
}

}  // namespace vdbfuse
