// SPDX-License-Identifier: Apache-2.0
// A flat folder of frames from a depth camera (the layout of 7-Scenes and of many recorders):
//
//   NAME.depth.png             16-bit grey; millimetres unless told otherwise; 0 and 65535 are invalid
//   NAME.depth.exr|npy|pfm|tiff  in its place; metres where it holds floats
//   NAME.pose.txt              4×4 or 3×4 world_from_camera, metres
//   NAME.color.png|jpg|jpeg    optional, taken as given (a picture that is not registered to the depth is not
//                              noticed)
//   *intrinsics*.txt           3×3 matrix of the depth camera, the same for all frames
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Reads poses, intrinsics and sizes at once, images when they are asked for. Frames are ordered by name.
/// Throws IoError: a depth map without a pose, a pose that is not a rotation (kRotationTolerance) or not
/// finite, intrinsics that are missing, several or short.
DepthSet readRgbdFolder(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat rgbdFormat();

}  // namespace vdbfuse
