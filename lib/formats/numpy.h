// SPDX-License-Identifier: Apache-2.0
// Arrays of numpy: what networks (VGGT, Depth Anything 3, DUSt3R and its kin, CUT3R) and scripts save. The
// set is one of
//
//   SET.npz                       arrays of all frames; or a folder that holds one such file
//   depth.npy, intrinsics.npy, …  the same arrays in a folder
//   NAME.npz, NAME.npz, …         a folder with one file a frame
//   depth/NAME.npy                a folder with one depth map a frame; beside it conf/NAME.npy,
//                                 camera/NAME.npz, color/NAME.png, …, or arrays of all frames
//
// Arrays by name (the first found counts; numpy_arrays.cpp has all names), each with or without a first
// dimension of frames; little or big endian, C or Fortran order:
//
//   depth, depths, depth_map…          H×W or H×W×1: z, 1 a unit in floats, 0.001 in whole numbers; 0,
//                                      negative, not finite (and 65535 in 16 bits) are invalid
//   intrinsics, intrinsic, K…          3×3, of the depth map's pixels, centres at integers
//   world_from_camera, cam2world, c2w, pose, poses, camera_poses…        4×4 or 3×4, x right, y down, z
//                                                                        forward
//   camera_from_world, w2c, world2cam, extrinsic, extrinsics…            the inverse of that
//   confidence, conf, depth_conf…      optional, of the depth's size
//   color, rgb, images…                optional, H×W×3 or 3×H×W: bytes, or floats from 0 to 1; any size
//
// Where poses of both directions are there, world_from_camera counts.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Reads the cameras at once, depths when they are asked for: one frame is in memory at a time, but a
/// compressed or Fortran-ordered array of many frames is held. Throws IoError: an array that is missing,
/// broken, or of another shape or number of frames; a pose or camera that is none.
DepthSet readNumpy(const std::filesystem::path& path, const ReadOptions& options);

/// Writes depth_set.npz, uncompressed: depth N×H×W float32, intrinsics N×3×3 and world_from_camera N×4×4
/// float64, confidence N×H×W float32 and color N×H×W×3 uint8 where all views have them. Views of several
/// sizes: a file NAME.npz each, without the dimension of frames.
void writeNumpy(const std::filesystem::path& folder, const ViewSequence& views, const WriteOptions& options,
                const Progress& progress);

DepthSetFormat numpyFormat();

}  // namespace vdbfuse
