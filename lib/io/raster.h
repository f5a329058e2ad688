// SPDX-License-Identifier: Apache-2.0
// One number a pixel, from whatever kind of file holds it: PNG, PFM, EXR, NPY, TIFF, maps of COLMAP,
// told apart by their first bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse::io {

enum class RasterKind { Png, Pfm, Exr, Npy, Tiff, Colmap };

struct RasterHeader {
  RasterKind kind = RasterKind::Png;
  int width = 0, height = 0;
  /// Of a stored number; numbers without a sign and of 16 bits are saturated at 65535.
  int bits = 0;
  enum class Number { Unsigned, Signed, Float } number = Number::Unsigned;

  bool isFloat() const { return number == Number::Float; }
  /// "16-bit PNG", "32-bit float EXR".
  std::string text() const;
};

/// Whether the first bytes are those of such a file.
bool isRaster(const std::filesystem::path& path);

/// Throws IoError when the file is none of these, or has more than one number a pixel (EXR: no channel Z,
/// depth, Y or V, and more than one).
RasterHeader readRasterHeader(const std::filesystem::path& path);

/// The numbers as stored, the top row first. Throws IoError.
Image<float> readRaster(const std::filesystem::path& path);

}  // namespace vdbfuse::io
