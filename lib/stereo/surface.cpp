// SPDX-License-Identifier: Apache-2.0
#include "stereo/surface.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "stereo/bit_rows.h"
#include "vdbfuse/base/rows.h"

namespace vdbfuse::stereo {
namespace {

constexpr std::size_t kRows = 16;  // of a chunk

Image<float> halvedMean(const Image<float>& full) {
  Image<float> half((full.width() + 1) / 2, (full.height() + 1) / 2);
  forEachRow(half.height(), kRows, [&](int y) {
    for (int x = 0; x < half.width(); ++x) {
      float sum = 0, count = 0;
      for (int k = 0; k < 4; ++k) {
        const int at_x = 2 * x + k % 2, at_y = 2 * y + k / 2;
        if (!full.contains(at_x, at_y) || full(at_x, at_y) == 0) continue;
        sum += full(at_x, at_y), count += 1;
      }
      half(x, y) = count > 0 ? sum / count : 0.0F;
    }
  });
  return half;
}

// The pixel of the half size that lies nearest, and its neighbour on the other side.
struct Between {
  int near, far;
};
Between between(int i, int size) {
  const int near = i / 2;
  return {near, std::clamp(near + (i % 2 == 0 ? -1 : 1), 0, size - 1)};
}

float linear(const Image<float>& half, Between x, Between y) {
  return 0.5625F * half(x.near, y.near) + 0.1875F * (half(x.far, y.near) + half(x.near, y.far)) +
         0.0625F * half(x.far, y.far);
}

void fillFrom(const Image<float>& half, Image<float>& full) {
  forEachRow(full.height(), kRows, [&](int y) {
    const Between rows = between(y, half.height());
    for (int x = 0; x < full.width(); ++x)
      if (full(x, y) == 0) full(x, y) = linear(half, between(x, half.width()), rows);
  });
}

constexpr std::array<std::array<int, 2>, 8> kDirections = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};

// The plane at (x, y) of the best pixel `distance` away in the directions where there is a usable one.
float bestPlane(const DepthLayer& layer, const PlaneMap& planes, int x, int y, int distance,
                const std::array<std::uint64_t, 8>& usable) {
  float best = 0, inverse_depth = 0;
  for (std::size_t k = 0; k < kDirections.size(); ++k) {
    if ((usable[k] >> (x % BitRows::kBits) & 1) == 0) continue;
    const int dx = distance * kDirections[k][0], dy = distance * kDirections[k][1];
    if (layer.score(x + dx, y + dy) <= best) continue;
    best = layer.score(x + dx, y + dy);
    inverse_depth = planes.value(x + dx, y + dy) - static_cast<float>(dx) * planes.dx(x + dx, y + dy) -
                    static_cast<float>(dy) * planes.dy(x + dx, y + dy);
  }
  return inverse_depth;
}

// For the pixels of a word whose bits are in `open`.
void takeNearest(const DepthLayer& layer, const PlaneMap& planes, const BitRows& usable, int word, int y,
                 std::uint64_t open, Image<float>& inverse_depth) {
  constexpr int kFurthest = 12;
  for (int distance = 1; distance <= kFurthest && open != 0; ++distance) {
    std::array<std::uint64_t, 8> there{};
    std::uint64_t any = 0;
    for (std::size_t k = 0; k < kDirections.size(); ++k) {
      there[k] = usable.moved(word, y + distance * kDirections[k][1], distance * kDirections[k][0]);
      any |= there[k];
    }
    for (std::uint64_t found = open & any; found != 0; found &= found - 1) {
      const int x = word * BitRows::kBits + std::countr_zero(found);
      inverse_depth(x, y) = bestPlane(layer, planes, x, y, distance, there);
    }
    open &= ~any;
  }
}

}  // namespace

DepthLayer emptyLayer(int width, int height) {
  const Image<float> zero(width, height);
  return {zero, zero, zero, zero, Image<std::uint8_t>(width, height), zero};
}

void store(const ModeRows& modes, std::size_t pixel, float inverse_depth, float step, int x, int y,
           DepthLayer& layer) {
  layer.inverse_depth(x, y) = inverse_depth;
  layer.score(x, y) = modes.score[pixel];
  layer.support(x, y) = modes.support[pixel];
  layer.second(x, y) = modes.second[pixel];
  layer.voters(x, y) = static_cast<std::uint8_t>(modes.voters[pixel]);
  layer.spread2(x, y) = modes.spread2[pixel] * step * step;
}

Image<float> filled(const Image<float>& inverse_depth, float otherwise) {
  std::vector<Image<float>> pyramid{inverse_depth};
  while (pyramid.back().width() > 1 || pyramid.back().height() > 1)
    pyramid.push_back(halvedMean(pyramid.back()));
  if (pyramid.back()(0, 0) == 0) pyramid.back()(0, 0) = otherwise;
  for (std::size_t level = pyramid.size() - 1; level > 0; --level)
    fillFrom(pyramid[level], pyramid[level - 1]);
  return std::move(pyramid.front());
}

Guide guideOf(const DepthLayer& layer, const PlaneMap& planes) {
  constexpr float kLeastShare = 0.2F;
  const int width = planes.value.width(), height = planes.value.height();
  Guide guide{planes.value, {width, height}};
  const auto is_agreed = [&](int x, int y) { return planes.share(x, y) >= kLeastShare; };
  const BitRows usable(width, height, [&](int x, int y) { return is_agreed(x, y) && layer.score(x, y) > 0; });
  forEachRow(height, kRows, [&](int y) {
    for (int word = 0; word < BitRows::words(width); ++word) {
      std::uint64_t open = 0;
      for (int x = word * BitRows::kBits; x < std::min(width, (word + 1) * BitRows::kBits); ++x) {
        if (is_agreed(x, y)) continue;
        guide.is_foreign(x, y) = 1;
        guide.inverse_depth(x, y) = 0;
        open |= std::uint64_t{1} << (x % BitRows::kBits);
      }
      if (open != 0) takeNearest(layer, planes, usable, word, y, open, guide.inverse_depth);
    }
  });
  return guide;
}

DepthLayer doubled(const DepthLayer& layer, int width, int height, float step) {
  DepthLayer result = emptyLayer(width, height);
  const Image<float>& half = layer.inverse_depth;
  forEachRow(height, kRows, [&](int y) {
    const Between rows = between(y, half.height());
    for (int x = 0; x < width; ++x) {
      const Between columns = between(x, half.width());
      const std::array<float, 4> around = {half(columns.near, rows.near), half(columns.far, rows.near),
                                           half(columns.near, rows.far), half(columns.far, rows.far)};
      const auto [low, high] = std::minmax_element(around.begin(), around.end());
      const bool is_smooth = *low > 0 && *high - *low < step;
      result.inverse_depth(x, y) = is_smooth ? linear(half, columns, rows) : around[0];
      result.score(x, y) = layer.score(columns.near, rows.near);
      result.second(x, y) = layer.second(columns.near, rows.near);
      result.voters(x, y) = layer.voters(columns.near, rows.near);
      result.spread2(x, y) = layer.spread2(columns.near, rows.near);
    }
  });
  return result;
}

}  // namespace vdbfuse::stereo
