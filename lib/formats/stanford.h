// SPDX-License-Identifier: Apache-2.0
// Range scans of the Stanford 3D Scanning Repository: one .conf file, or the folder that holds it.
//
//   NAME.conf   bmesh FILE tx ty tz qx qy qz qw   a scan and its pose, one a line
//               camera …, mesh …                  not used
//   NAME.ply    formats/range_scan.h; metres, x right, y up, z towards the scanner
//
// The quaternion is that of scan_from_world's rotation: a point p of a scan is R(q)ᵀ p + t in the world.
// Taken as world_from_scan it puts the bunny's scans 5 to 130 mm off each other.
//
// Sensors are not stored. Cyberware's scanner moves a sheet of light sideways (PushBroom); its rows converge
// about 1.1 m away on the scan's +z side. Each scan's sensor is the one that fits its own points. Odd rows of
// these scans lie half a column aside ("interlaced"); depths are taken to the centres of the pixels.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// world_from_scan of a bmesh line. REQUIRES: the quaternion is not zero; it is brought to length 1.
RigidTransform stanfordPose(const Eigen::Vector3d& translation, double qx, double qy, double qz, double qw);

/// Reads every scan once to find its sensor (a pinhole at the scan's origin, else a push-broom), and again
/// when its depth is asked for; views are in the order of the file. A note says how well the sensors fit.
/// Throws IoError: no or several .conf files, a broken line, a scan that is missing, short or fits no sensor.
DepthSet readStanford(const std::filesystem::path& path, const ReadOptions& options);

DepthSetFormat stanfordFormat();

}  // namespace vdbfuse
