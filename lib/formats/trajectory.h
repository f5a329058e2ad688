// SPDX-License-Identifier: Apache-2.0
// Trajectories as the tools of the TUM RGB-D benchmark write them: "time tx ty tz qx qy qz qw" a line, lines
// with # are comments.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

struct StampedPose {
  double time = 0;  ///< seconds
  RigidTransform pose = RigidTransform::Identity();
};

/// Sorted by time. Throws IoError: a line that is no pose, no line at all.
std::vector<StampedPose> readTrajectory(const std::filesystem::path& path);

/// The pose at `time`: between its two neighbours where they are at most twice `tolerance` apart, else that
/// of a neighbour no further away than `tolerance`, else nothing.
std::optional<RigidTransform> poseAt(const std::vector<StampedPose>& trajectory, double time,
                                     double tolerance);

/// One line of such a file.
std::string trajectoryLine(const std::string& time, const RigidTransform& pose);

}  // namespace vdbfuse
