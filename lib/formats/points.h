// SPDX-License-Identifier: Apache-2.0
// Points in any order, with a known sensor. Two layouts:
//
// A folder of scans, each in the frame of its scanner (x forward, y left, z up), with poses:
//   NAME.ply|.xyz|.pcd   x y z; .pcd ascii or binary
//   NAME.pose.txt        4×4 or 3×4 world_from_scan
//   or trajectory.txt    name tx ty tz qx qy qz qw, a line a scan: names of the files with or without
//   extension,
//                        else (times) in the order of the files
//   or scanN.ply with poseN.txt, as MeshLib's tools for several scans are fed: 4×4 world_from_scan. No
//   written description of these pose files was found; that reading is taken.
//
// One file of points in world coordinates, each with the position of the sensor (formats/point_file.h).
// Points are taken together by that position; see formats/sensor_groups.h for sensors that move.
//
// A sensor's frame is level, or turned towards its points where these lie above or below, so that none is
// near a pole of the spherical depth map that they are made into.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Throws IoError: a scan without a pose or a pose without a scan, a broken file, points without a sensor.
DepthSet readPointScans(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat pointsFormat();

}  // namespace vdbfuse
