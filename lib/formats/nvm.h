// SPDX-License-Identifier: Apache-2.0
// What VisualSFM leaves (Wu, 3DV 2013):
//
//   NAME.nvm      "NVM_V3" [FixedK fx cx fy cy ...]; the number of cameras; of each the picture, f,
//   quaternion
//                 w x y z (camera_from_world, x right, y down, z forward), centre, k, 0; the number of
//                 points; of each its position, its colour, and how many cameras see it: camera, feature, x,
//                 y each. Blanks in names stand as "
//   the pictures  where it says, beside it or below
//
// The principal point is the middle of the picture, unless FixedK says another. Distortion leads from the
// picture to the ideal ray, the other way than everywhere else: ideal = (1 + k |m|²) m with m the ray of the
// picture, (x − cx)/f and (y − cy)/f. It is inverted exactly.
#pragma once

#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// `path` is the file, or a folder with one. The first model is read. Points give each photograph its depths.
/// Throws IoError.
ImageSet readNvm(const std::filesystem::path& path, const ImageReadOptions& options);

/// Without points. Throws InvalidArgument when a camera has two focal lengths or its principal point is not
/// in the middle.
void writeNvm(const std::filesystem::path& folder, const PhotographSequence& photographs,
              const ImageWriteOptions& options, const Progress& progress);

ImageSetFormat nvmImageFormat();

}  // namespace vdbfuse
