// SPDX-License-Identifier: Apache-2.0
// PNG files. Every error is an IoError that names the file; sizes are checked before memory is taken.
#pragma once

#include <cstdint>
#include <filesystem>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

/// What the first bytes of a PNG file say.
struct PngHeader {
  int width = 0, height = 0;
  int channels = 0;  ///< 1 grey or palette, 2 grey and alpha, 3 colour, 4 colour and alpha
  int bits = 0;      ///< of a channel
};

PngHeader readPngHeader(const std::filesystem::path& path);

/// Any kind of PNG as 8-bit colour; alpha is dropped.
Image<Rgb8> readPngRgb(const std::filesystem::path& path);
/// A grey PNG of at most 8 bits.
Image<std::uint8_t> readPngGrey8(const std::filesystem::path& path);
/// A grey PNG of 16 bits, values as stored.
Image<std::uint16_t> readPngGrey16(const std::filesystem::path& path);

/// The file is complete or absent. The same image gives the same bytes.
/// Throws InvalidArgument when the image is empty.
void writePng(const std::filesystem::path& path, const Image<Rgb8>& image);
void writePng(const std::filesystem::path& path, const Image<std::uint8_t>& image);
void writePng(const std::filesystem::path& path, const Image<std::uint16_t>& image);

}  // namespace vdbfuse
