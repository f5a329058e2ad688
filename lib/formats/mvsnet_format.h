// SPDX-License-Identifier: Apache-2.0
// Reading the folder layout of MVSNet, depth maps or photographs; see vdbfuse/formats/mvsnet.h for what it
// is.
#pragma once

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {

/// Reads cameras and sizes at once, images when they are asked for. The size of a depth map is the truth:
/// where the intrinsics were clearly made for an image 2, 4, 8 … times larger or smaller (or for the picture
/// in images/), they are scaled to the depth map and a note says so. A camera without a depth map is left out
/// with a note; a depth map without a camera is an error. Throws IoError.
DepthSet readMvsnet(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat mvsnetFormat();

/// The photographs of images/ that have a camera, with the depths its last line states. Cameras that were
/// made for pictures of another size, a quarter in many of these sets, are scaled to the picture. Throws
/// IoError.
ImageSet readMvsnetImages(const std::filesystem::path& path, const ImageReadOptions& options);

/// cams/ and images/.
void writeMvsnetImages(const std::filesystem::path& folder, const PhotographSequence& photographs,
                       const ImageWriteOptions& options, const Progress& progress);

ImageSetFormat mvsnetImageFormat();

}  // namespace vdbfuse
