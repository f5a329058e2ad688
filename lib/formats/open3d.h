// SPDX-License-Identifier: Apache-2.0
// Sequences of an RGB-D camera as Open3D and the Redwood data sets keep them:
//
//   depth/*.png             16-bit grey, millimetres; or .exr, .npy, .pfm, .tiff, lengths where it holds
//   floats color/ or image/ or rgb/   optional: PNG or JPEG of the depth map's name, or as many as depth
//   maps, in order trajectory.log          blocks "i j k" and a 4×4 matrix world_from_camera; or the only
//   *.log; or trajectory.json         Open3D's PinholeCameraTrajectory (or the only *trajectory*.json), which
//   has
//                           cameras, too: extrinsic is camera_from_world, matrices column by column
//   camera_intrinsic.json   Open3D's PinholeCameraIntrinsic; or intrinsic.json, camera_primesense.json, or
//   the
//                           only *intrinsic*.json. Pixel centres at integers. It counts before the cameras of
//                           a trajectory
//
// Depth maps are ordered by name, numbers in them by value. Where there are as many entries in the
// trajectory, they belong to the depth maps in that order; else the first number i of an entry of a .log is
// the place of its depth map in that order, from 0, and depth maps without an entry are left out.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Throws IoError: files are missing, several or broken; entries that no depth map belongs to.
DepthSet readOpen3d(const std::filesystem::path& path, const ReadOptions& options);

/// Writes depth/, color/ and, for one camera, trajectory.log and camera_intrinsic.json, for several
/// trajectory.json. Names are numbers, so that their order is that of the views.
void writeOpen3d(const std::filesystem::path& folder, const ViewSequence& views, const WriteOptions& options,
                 const Progress& progress);

DepthSetFormat open3dFormat();

}  // namespace vdbfuse
