// SPDX-License-Identifier: Apache-2.0
// Photographs of the Middlebury multi-view stereo evaluation (Seitz et al., CVPR 2006):
//
//   NAME_par.txt   first the number of photographs; then a line each: picture, K (9), R (9), t (3), row by
//   row,
//                  x = K (R X + t). fx and fy differ; pixel centres at integers
//   the pictures   beside it
//
// Other files of the folder, README.txt with its bounding box among them, are not read.
#pragma once

#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// `path` is the file, or a folder with one. Throws IoError, also when a camera has skew.
ImageSet readMiddlebury(const std::filesystem::path& path, const ImageReadOptions& options);

void writeMiddlebury(const std::filesystem::path& folder, const PhotographSequence& photographs,
                     const ImageWriteOptions& options, const Progress& progress);

ImageSetFormat middleburyImageFormat();

}  // namespace vdbfuse
