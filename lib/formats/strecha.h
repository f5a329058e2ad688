// SPDX-License-Identifier: Apache-2.0
// Photographs of Strecha et al., "On benchmarking camera calibration and multi-view stereo" (CVPR 2008):
//
//   0000.png.camera (or .jpg, ...)   beside the picture, or in cameras/ with the picture in images/:
//                                    K 3×3; three zeros; R 3×3, world_from_camera; the camera's centre C;
//                                    width and height. x = K Rᵀ (X − C), pixel centres at integers
#pragma once

#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// `path` is the folder of the camera files, or the one above cameras/. Throws IoError, also when a camera
/// has skew or distortion.
ImageSet readStrecha(const std::filesystem::path& path, const ImageReadOptions& options);

/// Camera files beside the pictures.
void writeStrecha(const std::filesystem::path& folder, const PhotographSequence& photographs,
                  const ImageWriteOptions& options, const Progress& progress);

ImageSetFormat strechaImageFormat();

}  // namespace vdbfuse
