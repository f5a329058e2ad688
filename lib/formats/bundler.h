// SPDX-License-Identifier: Apache-2.0
// What Bundler leaves (Snavely et al., SIGGRAPH 2006):
//
//   bundle.out    (or bundle/bundle.out) "# Bundle file v0.3"; numbers of cameras and points; of a camera f
//   k1
//                 k2, R 3×3, t, camera_from_world with x right, y up, z backward, f = 0: not found; of a
//                 point its position, its colour, and how many cameras see it: camera, key, x, y each
//   list.txt      a picture a line, in the order of the cameras; beside it, or above bundle/
//   the pictures  where list.txt says, or in images/
//
// The principal point is the middle of the picture. Distortion leads from the ideal ray p = (x/z, y/z) to the
// picture's (1 + k1 |p|² + k2 |p|⁴) p.
#pragma once

#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// `path` is the folder or the file. Points give each photograph its depths. Throws IoError.
ImageSet readBundler(const std::filesystem::path& path, const ImageReadOptions& options);

/// Without points. Throws InvalidArgument when a camera has two focal lengths or its principal point is not
/// in the middle.
void writeBundler(const std::filesystem::path& folder, const PhotographSequence& photographs,
                  const ImageWriteOptions& options, const Progress& progress);

ImageSetFormat bundlerImageFormat();

}  // namespace vdbfuse
