// SPDX-License-Identifier: Apache-2.0
#include "io/raster.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include "io/colmap_map.h"
#include "io/exr.h"
#include "io/file_bytes.h"
#include "io/npy.h"
#include "io/tiff.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;
using std::string_view_literals::operator""sv;

std::optional<RasterKind> kindOf(const fs::path& path) {
  constexpr std::pair<std::string_view, RasterKind> kMagics[] = {
      {"\x89PNG"sv, RasterKind::Png},          {"Pf"sv, RasterKind::Pfm},
      {"\x76\x2f\x31\x01"sv, RasterKind::Exr}, {"\x93NUMPY"sv, RasterKind::Npy},
      {"II*\0"sv, RasterKind::Tiff},           {"MM\0*"sv, RasterKind::Tiff}};
  const std::string start = readFileStart(path, 8);
  for (const auto& [magic, kind] : kMagics) {
    if (std::string_view(start).starts_with(magic)) return kind;
  }
  if (isColmapMap(start)) return RasterKind::Colmap;
  return std::nullopt;
}

RasterKind requireKind(const fs::path& path) {
  const std::optional<RasterKind> kind = kindOf(path);
  if (!kind) throw IoError(path, "", "a PNG, PFM, EXR, NPY or TIFF file", "something else");
  return *kind;
}

RasterHeader pngHeader(const fs::path& path) {
  const PngHeader png = readPngHeader(path);
  if (png.channels != 1)
    throw IoError(path, "", "a grey PNG", "one of " + std::to_string(png.channels) + " channels");
  return {RasterKind::Png, png.width, png.height, png.bits, RasterHeader::Number::Unsigned};
}

template <class T>
Image<float> asFloats(const Image<T>& image) {
  Image<float> result(image.width(), image.height());
  std::transform(image.begin(), image.end(), result.begin(), [](T v) { return static_cast<float>(v); });
  return result;
}

}  // namespace

std::string RasterHeader::text() const {
  constexpr const char* kNames[] = {"PNG", "PFM", "EXR", "NPY", "TIFF", "COLMAP map"};
  const char* sign = number == Number::Signed ? " signed" : number == Number::Float ? " float" : "";
  return std::to_string(bits) + "-bit" + sign + " " + kNames[static_cast<std::size_t>(kind)];
}

bool isRaster(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && kindOf(path).has_value();
}

RasterHeader readRasterHeader(const fs::path& path) {
  switch (requireKind(path)) {
    case RasterKind::Png:
      return pngHeader(path);
    case RasterKind::Pfm: {
      const PfmHeader pfm = readPfmHeader(path);
      return {RasterKind::Pfm, pfm.width, pfm.height, 32, RasterHeader::Number::Float};
    }
    case RasterKind::Exr:
      return readExrHeader(path);
    case RasterKind::Npy:
      return readNpyRasterHeader(path);
    case RasterKind::Tiff:
      return readTiffHeader(path);
    case RasterKind::Colmap:
      return readColmapMapHeader(path);
  }
  return {};
}

Image<float> readRaster(const fs::path& path) {
  switch (requireKind(path)) {
    case RasterKind::Png:
      return readPngHeader(path).bits == 16 ? asFloats(readPngGrey16(path)) : asFloats(readPngGrey8(path));
    case RasterKind::Pfm:
      return readPfm(path);
    case RasterKind::Exr:
      return readExr(path);
    case RasterKind::Npy:
      return readNpyRaster(path);
    case RasterKind::Tiff:
      return readTiff(path);
    case RasterKind::Colmap:
      return readColmapMap(path);
  }
  return {};
}

}  // namespace vdbfuse::io
