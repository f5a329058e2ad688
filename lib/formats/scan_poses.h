// SPDX-License-Identifier: Apache-2.0
// Files of poses beside scans.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

inline constexpr const char* kTrajectoryFile = "trajectory.txt";

/// The pose file of a scan: NAME.pose.txt, or poseN.txt of scanN; empty when there is neither.
std::filesystem::path poseFileOf(const std::filesystem::path& folder, const std::string& scan);

/// world_from_scan of each of the files, from trajectory.txt where there is one, else from their pose files.
/// Throws IoError: one is missing, or broken.
std::vector<RigidTransform> readScanPoses(const std::filesystem::path& folder,
                                          const std::vector<std::string>& files);

}  // namespace vdbfuse
