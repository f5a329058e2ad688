// SPDX-License-Identifier: Apache-2.0
// Depth in TIFF files.
#pragma once

#include "io/raster.h"

namespace vdbfuse::io {

/// Of the first image of the file. Throws IoError when it has more than one number a pixel.
RasterHeader readTiffHeader(const std::filesystem::path& path);

/// The numbers of the first image. Throws IoError.
Image<float> readTiff(const std::filesystem::path& path);

}  // namespace vdbfuse::io
