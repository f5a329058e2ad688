// SPDX-License-Identifier: Apache-2.0
// Pictures as their files hold them, before they become photographs.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <variant>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse::io {

/// Red, green, blue and opacity of 8 or 16 bits; grey: three equal parts.
template <class T>
using Rgba = std::array<T, 4>;

struct RgbaPicture {
  std::variant<Image<Rgba<std::uint8_t>>, Image<Rgba<std::uint16_t>>> pixels;
  bool is_grey = false;
};

struct PictureHeader {
  int width = 0, height = 0;
  bool has_alpha = false;  ///< a channel of opacity
};

/// Any kind of PNG; fewer bits than 8 become 8. Throws IoError.
RgbaPicture readPngRgba(const std::filesystem::path& path);
/// Opaque. Throws IoError.
RgbaPicture readJpegRgba(const std::filesystem::path& path);
/// The first image of a TIFF file. Of 16 bits: grey and RGB in strips, channels side by side; of fewer: all
/// that libtiff reads. Throws IoError.
RgbaPicture readTiffRgba(const std::filesystem::path& path);
PictureHeader readTiffPictureHeader(const std::filesystem::path& path);

}  // namespace vdbfuse::io
