// SPDX-License-Identifier: Apache-2.0
#include "stereo/reference_level.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/rows.h"

namespace vdbfuse::stereo {
namespace {

constexpr int kTileWidth = 128, kTileHeight = 48;

// Sums down the columns of the rows of a window. Whole numbers: exact for any window that fits a picture.
struct ColumnSums {
  std::vector<std::uint32_t> u, uu;
};

// Of the rows y − radius … y + radius.
void sumColumns(const PictureLevel& picture, int radius, int y, ColumnSums& sums) {
  const auto width = static_cast<std::size_t>(picture.camera.width);
  sums.u.assign(width, 0), sums.uu.assign(width, 0);
  for (int k = -radius; k <= radius; ++k) {
    const std::uint16_t* row = picture.value.row(y + k);
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint32_t value = row[x];
      sums.u[x] += value, sums.uu[x] += value * value;
    }
  }
}

// Of the windows around the pixels of row y, by running sums along it.
void windowRow(const ColumnSums& sums, int radius, float least_spread2, int y, ReferenceLevel& level) {
  const auto width = sums.u.size(), window = static_cast<std::size_t>(2 * radius + 1);
  const double share = 1.0 / static_cast<double>(window * window);
  std::uint64_t u = 0, uu = 0;
  for (std::size_t x = 0; x < width; ++x) {
    u += sums.u[x], uu += sums.uu[x];
    if (x + 1 < window) continue;
    const double mean = static_cast<double>(u) * share;
    const double spread2 = static_cast<double>(uu) - mean * static_cast<double>(u);
    const int centre = static_cast<int>(x) - radius;
    level.mean(centre, y) = static_cast<float>(mean);
    if (spread2 >= least_spread2)
      level.inverse_spread(centre, y) = static_cast<float>(1 / std::sqrt(spread2));
    u -= sums.u[x + 1 - window], uu -= sums.uu[x + 1 - window];
  }
}

// Σ(u − mean)² of the nine pixels around.
double innerSpread2(const PictureLevel& picture, int x, int y) {
  std::uint32_t u = 0, uu = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    const std::uint16_t* row = picture.value.row(y + dy) + x;
    for (int dx = -1; dx <= 1; ++dx) {
      const std::uint32_t value = row[dx];
      u += value, uu += value * value;
    }
  }
  return static_cast<double>(uu) - static_cast<double>(u) * static_cast<double>(u) / 9;
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

// Calls use(x of the tile, column of the level) for a row with its margin; beyond the border the last pixel
// is repeated.
template <class Use>
void forEachColumn(int first, int count, int width, const Use& use) {
  const int left = std::min(count, std::max(0, -first)), right = std::clamp(width - first, left, count);
  for (int x = 0; x < left; ++x) use(x, 0);
  for (int x = left; x < right; ++x) use(x, first + x);
  for (int x = right; x < count; ++x) use(x, width - 1);
}

// SweepTile::products of row y of the tile.
void fillProducts(const PictureLevel& picture, int y, SweepTile& tile) {
  const auto row = [&](int at) {
    return picture.value.row(std::clamp(tile.y0 - tile.radius + at, 0, picture.camera.height - 1));
  };
  const std::uint16_t* value = row(y);
  std::int32_t* products = tile.products.data() + tile.at(0, y);
  const int first = tile.x0 - tile.radius, width = picture.camera.width;
  if (y < tile.window()) {
    forEachColumn(first, tile.stride, width, [&](int x, int column) { products[x] = value[column]; });
    return;
  }
  const std::uint16_t* before = row(y - tile.window());
  forEachColumn(first, tile.stride, width,
                [&](int x, int column) { products[x] = packed(value[column], before[column]); });
}

// All but the base.
void fillTile(const ReferenceLevel& level, const TileRect& rect, SweepTile& tile) {
  const int radius = level.radius;
  tile.x0 = rect.x0, tile.y0 = rect.y0, tile.width = rect.width, tile.height = rect.height;
  tile.radius = radius;
  tile.stride = (rect.width + 2 * radius + kVectorLanes - 1) / kVectorLanes * kVectorLanes;
  tile.products.resize(tile.at(0, rect.height + 2 * radius));
  tile.base.resize(tile.products.size());
  for (int y = 0; y < rect.height + 2 * radius; ++y) fillProducts(*level.picture, y, tile);
  tile.mean.assign(tile.at(0, rect.height), 0.0F);
  tile.inverse_spread.assign(tile.at(0, rect.height), 0.0F);
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
    ColumnSums sums;
    for (std::size_t y = begin; y < end; ++y) {
      sumColumns(picture, radius, static_cast<int>(y) + radius, sums);
      windowRow(sums, radius, least_spread2, static_cast<int>(y) + radius, level);
    }
  });
  if (!picture.mask.empty()) leaveOutMasked(picture.mask, level.inverse_spread);
  return level;
}

void leaveOutRims(ReferenceLevel& level) {
  constexpr double kLeastShare = 0.02;
  const PictureLevel& picture = *level.picture;
  const int radius = level.radius;
  const double area = (2.0 * radius + 1) * (2.0 * radius + 1);
  forEachRow(picture.camera.height, 32, [&](int y) {
    for (int x = radius; x < picture.camera.width - radius; ++x) {
      float& inverse_spread = level.inverse_spread(x, y);
      if (inverse_spread == 0) continue;
      const auto inverse = static_cast<double>(inverse_spread);
      if (innerSpread2(picture, x, y) / 9 < kLeastShare / (inverse * inverse * area)) inverse_spread = 0;
    }
  });
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
  fillTile(level, rect, tile);
  for (int y = 0; y < rect.height + 2 * level.radius; ++y) {
    const float* row =
        inverse_depth.row(std::clamp(rect.y0 - level.radius + y, 0, inverse_depth.height() - 1));
    float* base = tile.base.data() + tile.at(0, y);
    forEachColumn(rect.x0 - level.radius, tile.stride, inverse_depth.width(),
                  [&](int x, int column) { base[x] = row[column]; });
  }
}

void prepareTile(const ReferenceLevel& level, const TileRect& rect, float inverse_depth, SweepTile& tile) {
  fillTile(level, rect, tile);
  std::fill(tile.base.begin(), tile.base.end(), inverse_depth);
}

}  // namespace vdbfuse::stereo
