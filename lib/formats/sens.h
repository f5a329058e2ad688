// SPDX-License-Identifier: Apache-2.0
// The .sens files of BundleFusion and ScanNet, version 4: one file, or a folder that holds one. All numbers
// are little-endian; matrices are 4×4 floats, row by row:
//
//   uint32 version 4; uint64 length of the sensor's name, its bytes
//   intrinsics and extrinsics of the colour camera, intrinsics and extrinsics of the depth camera
//   int32 colour compression (0 raw, 1 PNG, 2 JPEG), int32 depth compression (0 raw, 1 zlib, 2 occi)
//   uint32 width and height of colour, width and height of depth; float depth_shift
//   uint64 number of frames, and per frame:
//     world_from_camera of the depth camera; uint64 time of colour, time of depth (not read)
//     uint64 bytes of colour, uint64 bytes of depth, colour, depth
//
// Depth is uint16 / depth_shift lengths, z; 0 and 65535 are invalid. Pixel centres are at integers. Frames
// whose pose is not finite (ScanNet marks lost ones with -inf) are left out. Extrinsics are taken as
// BundleFusion uses them, camera_from_rig: world_from_color = world_from_depth E_depth E_color⁻¹ (ScanNet's
// are the identity).
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Reads where the frames lie at once, and images when they are asked for. Throws IoError: another version, a
/// depth compression that is not covered, sizes beyond the file, a pose or intrinsics that are none.
DepthSet readSens(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat sensFormat();

}  // namespace vdbfuse
