// SPDX-License-Identifier: Apache-2.0
// Sweeps of a turning laser with poses: a sequence of KITTI odometry, and what others write like it.
//
//   velodyne/*.bin | velodyne_points/data/*.bin | *.bin
//                     little-endian floats x y z intensity a point, x forward, y left, z up, metres
//   calib.txt         optional; "Tr:" and 12 numbers: 3×4 camera0_from_lidar, row by row
//   poses.txt         12 numbers a line: 3×4 world_from_camera0, or without calib.txt world_from_lidar
//   poses/NAME.txt    in its place a file for every sweep, 3×4 or 4×4
//
// Without either, ../../poses/FOLDER.txt is looked for, where KITTI keeps it. Lines belong to sweeps in the
// order of their names; where there are more lines, sweep 000012.bin has the line after twelve others.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Reads the poses, and every sweep once to find the image it is sorted into; again when its depth map is
/// asked for. Throws IoError: a sweep without a pose, a file that is no whole number of points, a pose that
/// is no rigid transform.
DepthSet readKitti(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat kittiFormat();

}  // namespace vdbfuse
