// SPDX-License-Identifier: Apache-2.0
// Maps of COLMAP's dense stereo: "width&height&channels&" in digits, then little-endian floats, one channel
// after the other, each row by row from the top.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "io/raster.h"

namespace vdbfuse::io {

/// Whether a file that begins so can be one: digits and '&' among the first bytes.
bool isColmapMap(std::string_view start);

/// Of a map of one channel. Throws IoError, also when the file is not as long as its header says.
RasterHeader readColmapMapHeader(const std::filesystem::path& path);
Image<float> readColmapMap(const std::filesystem::path& path);

/// All images of one size. The file is complete or absent. Throws IoError.
void writeColmapMap(const std::filesystem::path& path, const std::vector<Image<float>>& channels);

}  // namespace vdbfuse::io
