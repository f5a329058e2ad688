// SPDX-License-Identifier: Apache-2.0
#include "stereo/picture_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vdbfuse/base/rows.h"

namespace vdbfuse::stereo {
namespace {

constexpr std::size_t kRows = 64;  // of a chunk

Image<std::uint16_t> wholeNumbers(const Image<float>& brightness) {
  Image<std::uint16_t> value(brightness.width(), brightness.height());
  forEachRow(value.height(), kRows, [&](int y) {
    std::transform(brightness.row(y), brightness.row(y) + value.width(), value.row(y), [](float b) {
      return static_cast<std::uint16_t>(std::clamp(b, 0.0F, 1.0F) * kWhite + 0.5F);
    });
  });
  return value;
}

// The four columns or rows that pixel `i` of the half size is made of.
std::array<int, 4> sources(int i, int size) {
  std::array<int, 4> at{};
  for (int k = 0; k < 4; ++k) at[static_cast<std::size_t>(k)] = std::clamp(2 * i - 1 + k, 0, size - 1);
  return at;
}

int smoothed(int a, int b, int c, int d) { return a + 3 * (b + c) + d; }

Image<std::uint16_t> halved(const Image<std::uint16_t>& full) {
  Image<std::uint16_t> half((full.width() + 1) / 2, (full.height() + 1) / 2);
  forEachRow(half.height(), kRows, [&](int y) {
    const std::array<int, 4> rows = sources(y, full.height());
    const auto column = [&](int x) {
      return smoothed(full(x, rows[0]), full(x, rows[1]), full(x, rows[2]), full(x, rows[3]));
    };
    for (int x = 0; x < half.width(); ++x) {
      const std::array<int, 4> c = sources(x, full.width());
      const int sum = smoothed(column(c[0]), column(c[1]), column(c[2]), column(c[3]));
      half(x, y) = static_cast<std::uint16_t>((sum + 32) >> 6);
    }
  });
  return half;
}

Image<std::uint8_t> halvedMask(const Image<std::uint8_t>& full) {
  if (full.empty()) return {};
  Image<std::uint8_t> half((full.width() + 1) / 2, (full.height() + 1) / 2);
  forEachRow(half.height(), kRows, [&](int y) {
    for (int x = 0; x < half.width(); ++x) {
      const int right = std::min(2 * x + 1, full.width() - 1), below = std::min(2 * y + 1, full.height() - 1);
      const bool used = full(2 * x, 2 * y) && full(right, 2 * y) && full(2 * x, below) && full(right, below);
      half(x, y) = used ? 1 : 0;
    }
  });
  return half;
}

Image<std::uint64_t> quadsOf(const Image<std::uint16_t>& value) {
  Image<std::uint64_t> quads(value.width(), value.height());
  forEachRow(quads.height(), kRows, [&](int y) {
    const std::uint16_t* upper = value.row(y);
    const std::uint16_t* lower = value.row(std::min(y + 1, value.height() - 1));
    const auto pair = [&](const std::uint16_t* row, int x) {
      return row[x] | static_cast<std::uint64_t>(row[std::min(x + 1, value.width() - 1)]) << 16;
    };
    for (int x = 0; x < value.width(); ++x) quads(x, y) = pair(upper, x) | pair(lower, x) << 32;
  });
  return quads;
}

Pinhole halvedCamera(const Pinhole& full, int width, int height) {
  Pinhole half = full;
  half.width = width, half.height = height;
  half.fx /= 2, half.fy /= 2;
  half.cx = (full.cx + 0.5) / 2 - 0.5, half.cy = (full.cy + 0.5) / 2 - 0.5;
  return half;
}

}  // namespace

std::vector<PictureLevel> picturePyramid(const Photograph& photograph, int levels) {
  std::vector<PictureLevel> pyramid;
  pyramid.push_back({photograph.camera, wholeNumbers(photograph.brightness), {}, photograph.mask});
  for (int level = 1; level < levels; ++level) {
    const PictureLevel& full = pyramid.back();
    Image<std::uint16_t> half = halved(full.value);
    const Pinhole camera = halvedCamera(full.camera, half.width(), half.height());
    pyramid.push_back({camera, std::move(half), {}, halvedMask(full.mask)});
  }
  for (PictureLevel& level : pyramid) level.quads = quadsOf(level.value);
  return pyramid;
}

}  // namespace vdbfuse::stereo
