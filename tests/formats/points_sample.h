// SPDX-License-Identifier: Apache-2.0
// The tiny scene as points in any order, in every layout of the format points.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse::test {

/// Points on the surface, 0.025 apart.
std::vector<Eigen::Vector3d> tinySurface();

/// world_from_scan of two scanners above it, x forward, y left, z up.
std::vector<RigidTransform> tinyScanners();

void writeXyzWithPoses(const std::filesystem::path& folder);          ///< NAME.xyz, NAME.pose.txt
void writePcdWithTrajectory(const std::filesystem::path& folder);     ///< binary .pcd, trajectory.txt
void writePlyWithNumberedPoses(const std::filesystem::path& folder);  ///< scan000.ply, pose000.txt
void writePlyWithSensors(const std::filesystem::path& folder);        ///< points.ply, binary doubles
void writeXyzWithSensors(const std::filesystem::path& folder);        ///< points.xyz, six columns
void writePcdWithSensors(const std::filesystem::path& folder);        ///< points.pcd, ascii, vp_x vp_y vp_z

}  // namespace vdbfuse::test
