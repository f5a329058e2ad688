// SPDX-License-Identifier: Apache-2.0
// Grey PFM (portable float map): "Pf", width and height, a number whose sign tells the byte order (negative:
// least significant byte first), then 32-bit floats, the bottom row first.
#pragma once

#include <filesystem>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

struct PfmHeader {
  int width = 0, height = 0;
};

/// Throws IoError, also when the file is shorter than its header promises.
PfmHeader readPfmHeader(const std::filesystem::path& path);

/// Values as stored (not finite ones too), the top row first. Throws IoError.
Image<float> readPfm(const std::filesystem::path& path);

/// Little-endian. The file is complete or absent. Throws IoError; InvalidArgument when the image is empty.
void writePfm(const std::filesystem::path& path, const Image<float>& image);

}  // namespace vdbfuse
