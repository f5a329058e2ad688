// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <utility>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

/// A JPEG file as 8-bit colour. Throws IoError, also when the file ends too early.
Image<Rgb8> readJpeg(const std::filesystem::path& path);

/// Width and height, from its header. Throws IoError.
std::pair<int, int> readJpegSize(const std::filesystem::path& path);

}  // namespace vdbfuse
