// SPDX-License-Identifier: Apache-2.0
#include "stereo/reference_level.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kTileWidth = 128, kTileHeight = 48;

struct Sums {
  std::int64_t u = 0, uu = 0;
  Sums& add(std::int64_t value, int sign) {
    u += sign * value, uu += sign * value * value;
    return *this;
  }
};

// Of the windows around the pixels of row y, by running sums along it.
void windowRow(const PictureLevel& picture, int radius, float least_spread2, int y, ReferenceLevel& level) {
  const int width = picture.camera.width, window = 2 * radius + 1;
  const double share = 1.0 / (window * window);
  Sums sums;
  const auto addColumn = [&](int x, int sign) {
    for (int k = -radius; k <= radius; ++k) sums.add(picture.value(x, y + k), sign);
  };
  for (int x = 0; x < window - 1; ++x) addColumn(x, 1);
  for (int x = radius; x < width - radius; ++x) {
    addColumn(x + radius, 1);
    const double mean = static_cast<double>(sums.u) * share;
    const double spread2 = static_cast<double>(sums.uu) - mean * static_cast<double>(sums.u);
    level.mean(x, y) = static_cast<float>(mean);
    if (spread2 >= least_spread2) level.inverse_spread(x, y) = static_cast<float>(1 / std::sqrt(spread2));
    addColumn(x - radius, -1);
  }
}

void leaveOutMasked(const Image<std::uint8_t>& mask, Image<float>& inverse_spread) {
  std::transform(mask.begin(), mask.end(), inverse_spread.begin(), inverse_spread.begin(),
                 [](std::uint8_t used, float spread) { return used ? spread : 0.0F; });
}

bool hasWindow(const ReferenceLevel& level, const TileRect& rect) {
  for (int y = rect.y0; y < rect.y0 + rect.height; ++y) {
    const float* row = level.inverse_spread.row(y) + rect.x0;
    if (std::any_of(row, row + rect.width, [](float s) { return s > 0; })) return true;
  }
  return false;
}

// u(x, y) | −u(x, y − window) << 16, as a whole number.
std::int32_t packed(std::int32_t value, std::int32_t before) { return value - before * 65536; }

template <class InverseDepth>
void fillTile(const ReferenceLevel& level, const TileRect& rect, const InverseDepth& inverse_depth,
              SweepTile& tile) {
  const PictureLevel& picture = *level.picture;
  const int radius = level.radius, width = picture.camera.width, height = picture.camera.height;
  tile.x0 = rect.x0, tile.y0 = rect.y0, tile.width = rect.width, tile.height = rect.height;
  tile.radius = radius;
  tile.stride = (rect.width + 2 * radius + kVectorLanes - 1) / kVectorLanes * kVectorLanes;
  tile.products.assign(tile.at(0, rect.height + 2 * radius), 0);
  tile.base.resize(tile.products.size());
  tile.mean.assign(tile.at(0, rect.height), 0.0F);
  tile.inverse_spread.assign(tile.at(0, rect.height), 0.0F);
  for (int y = 0; y < rect.height + 2 * radius; ++y) {
    const int row = std::clamp(rect.y0 - radius + y, 0, height - 1);
    const int before = std::clamp(rect.y0 - radius + y - tile.window(), 0, height - 1);
    for (int x = 0; x < tile.stride; ++x) {
      const int column = std::clamp(rect.x0 - radius + x, 0, width - 1);
      const int old = y >= tile.window() ? picture.value(column, before) : 0;
      tile.products[tile.at(x, y)] = packed(picture.value(column, row), old);
      tile.base[tile.at(x, y)] = inverse_depth(column, row);
    }
  }
  for (int y = 0; y < rect.height; ++y) {
    std::copy_n(level.mean.row(rect.y0 + y) + rect.x0, rect.width, &tile.mean[tile.at(0, y)]);
    std::copy_n(level.inverse_spread.row(rect.y0 + y) + rect.x0, rect.width,
                &tile.inverse_spread[tile.at(0, y)]);
  }
}

}  // namespace

ReferenceLevel referenceLevel(const PictureLevel& picture, int radius, float least_deviation) {
  const int width = picture.camera.width, height = picture.camera.height, window = 2 * radius + 1;
  ReferenceLevel level{&picture, radius, Image<float>(width, height), Image<float>(width, height)};
  if (width < window || height < window) return level;
  const float deviation = least_deviation * static_cast<float>(kWhite);
  const float least_spread2 = deviation * deviation * static_cast<float>(window * window);
  parallelFor(static_cast<std::size_t>(height - 2 * radius), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y)
      windowRow(picture, radius, least_spread2, static_cast<int>(y) + radius, level);
  });
  if (!picture.mask.empty()) leaveOutMasked(picture.mask, level.inverse_spread);
  return level;
}

std::vector<TileRect> tilesOf(const ReferenceLevel& level) {
  const int width = level.mean.width(), height = level.mean.height();
  std::vector<TileRect> tiles;
  for (int y = 0; y < height; y += kTileHeight) {
    for (int x = 0; x < width; x += kTileWidth) {
      const TileRect rect{x, y, std::min(kTileWidth, width - x), std::min(kTileHeight, height - y)};
      if (hasWindow(level, rect)) tiles.push_back(rect);
    }
  }
  return tiles;
}

void prepareTile(const ReferenceLevel& level, const TileRect& rect, const Image<float>& inverse_depth,
                 SweepTile& tile) {
  fillTile(
      level, rect, [&](int x, int y) { return inverse_depth(x, y); }, tile);
}

void prepareTile(const ReferenceLevel& level, const TileRect& rect, float inverse_depth, SweepTile& tile) {
  fillTile(
      level, rect, [&](int, int) { return inverse_depth; }, tile);
}

}  // namespace vdbfuse::stereo
