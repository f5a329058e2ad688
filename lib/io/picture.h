// SPDX-License-Identifier: Apache-2.0
// Photographs: PNG, JPEG and TIFF files of up to 16 bits, grey or colour, told apart by their first bytes.
#pragma once

#include <cstdint>
#include <filesystem>

#include "io/rgba_picture.h"
#include "vdbfuse/geometry/image.h"

namespace vdbfuse::io {

struct Picture {
  Image<float> brightness;  ///< in [0, 1] at the precision of the file: brightnessOf() its colours
  Image<Rgb8> color;        ///< empty: the file is grey
  /// 255 where the picture is at least half opaque, else 0; empty: it is everywhere opaque.
  Image<std::uint8_t> opaque;
};

/// Whether the first bytes are those of such a file.
bool isPictureFile(const std::filesystem::path& path);

/// Size and kind without the pixels. Throws IoError.
PictureHeader readPictureHeader(const std::filesystem::path& path);

/// Throws IoError.
Picture readPictureFile(const std::filesystem::path& path);

}  // namespace vdbfuse::io
