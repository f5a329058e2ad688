// SPDX-License-Identifier: Apache-2.0
#include "io/picture.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/jpeg.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;
using std::string_view_literals::operator""sv;

enum class PictureKind { Png, Jpeg, Tiff };

std::optional<PictureKind> kindOf(const fs::path& path) {
  constexpr std::pair<std::string_view, PictureKind> kMagics[] = {{"\x89PNG"sv, PictureKind::Png},
                                                                  {"\xff\xd8\xff"sv, PictureKind::Jpeg},
                                                                  {"II*\0"sv, PictureKind::Tiff},
                                                                  {"MM\0*"sv, PictureKind::Tiff}};
  const std::string start = readFileStart(path, 4);
  for (const auto& [magic, kind] : kMagics) {
    if (std::string_view(start).starts_with(magic)) return kind;
  }
  return std::nullopt;
}

PictureKind requireKind(const fs::path& path) {
  const std::optional<PictureKind> kind = kindOf(path);
  if (!kind) throw IoError(path, "", "a PNG, JPEG or TIFF file", "something else");
  return *kind;
}

// The nearest of 256 steps.
template <class T>
std::uint8_t byteOf(T value) {
  constexpr std::uint32_t kStep = std::numeric_limits<T>::max() / 255;
  return static_cast<std::uint8_t>((value + kStep / 2) / kStep);
}

template <class T>
Picture pictureOf(const Image<Rgba<T>>& pixels, bool is_grey) {
  constexpr T kHalf = std::numeric_limits<T>::max() / 2;
  Picture picture;
  picture.brightness = Image<float>(pixels.width(), pixels.height());
  std::transform(pixels.begin(), pixels.end(), picture.brightness.begin(), [](const Rgba<T>& p) {
    return brightnessOf(p[0], p[1], p[2], std::numeric_limits<T>::max());
  });
  if (!is_grey) {
    picture.color = Image<Rgb8>(pixels.width(), pixels.height());
    std::transform(pixels.begin(), pixels.end(), picture.color.begin(), [](const Rgba<T>& p) {
      return Rgb8{byteOf(p[0]), byteOf(p[1]), byteOf(p[2])};
    });
  }
  const auto is_opaque = [](const Rgba<T>& p) { return p[3] == std::numeric_limits<T>::max(); };
  if (std::all_of(pixels.begin(), pixels.end(), is_opaque)) return picture;
  picture.opaque = Image<std::uint8_t>(pixels.width(), pixels.height());
  std::transform(pixels.begin(), pixels.end(), picture.opaque.begin(),
                 [](const Rgba<T>& p) -> std::uint8_t { return p[3] > kHalf ? 255 : 0; });
  return picture;
}

RgbaPicture readRgba(const fs::path& path) {
  switch (requireKind(path)) {
    case PictureKind::Png:
      return readPngRgba(path);
    case PictureKind::Jpeg:
      return readJpegRgba(path);
    case PictureKind::Tiff:
      return readTiffRgba(path);
  }
  return {};
}

}  // namespace

bool isPictureFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && kindOf(path).has_value();
}

PictureHeader readPictureHeader(const fs::path& path) {
  switch (requireKind(path)) {
    case PictureKind::Png: {
      const PngHeader png = readPngHeader(path);
      return {png.width, png.height, png.channels % 2 == 0};
    }
    case PictureKind::Jpeg: {
      const auto [width, height] = readJpegSize(path);
      return {width, height, false};
    }
    case PictureKind::Tiff:
      return readTiffPictureHeader(path);
  }
  return {};
}

Picture readPictureFile(const fs::path& path) {
  const RgbaPicture file = readRgba(path);
  return std::visit([&](const auto& pixels) { return pictureOf(pixels, file.is_grey); }, file.pixels);
}

}  // namespace vdbfuse::io
