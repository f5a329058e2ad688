// SPDX-License-Identifier: Apache-2.0
// Depth in OpenEXR files.
#pragma once

#include "io/raster.h"

namespace vdbfuse::io {

/// Of the channel Z, or of the one called depth, Y or V, or of the only one. Throws IoError.
RasterHeader readExrHeader(const std::filesystem::path& path);

/// That channel, on the pixels of the display window; what lies outside the data window is 0. Throws IoError.
Image<float> readExr(const std::filesystem::path& path);

/// One channel Z of 32-bit floats. The file is complete or absent. Throws IoError.
void writeExr(const std::filesystem::path& path, const Image<float>& image);

}  // namespace vdbfuse::io
