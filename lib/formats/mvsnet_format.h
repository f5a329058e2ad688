// SPDX-License-Identifier: Apache-2.0
// Reading the folder layout of MVSNet; see vdbfuse/formats/mvsnet.h for what it is.
#pragma once

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Reads cameras and sizes at once, images when they are asked for. The size of a depth map is the truth:
/// where the intrinsics were clearly made for an image 2, 4, 8 … times larger or smaller (or for the picture
/// in images/), they are scaled to the depth map and a note says so. A camera without a depth map is left out
/// with a note; a depth map without a camera is an error. Throws IoError.
DepthSet readMvsnet(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat mvsnetFormat();

}  // namespace vdbfuse
