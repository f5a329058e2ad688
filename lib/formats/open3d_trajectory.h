// SPDX-License-Identifier: Apache-2.0
// Camera files of Open3D and Redwood.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

struct TrajectoryEntry {
  std::optional<std::int64_t> index;  ///< the first number of its line in a .log
  RigidTransform world_from_camera = RigidTransform::Identity();
  std::optional<Pinhole> camera;  ///< .json only; centres at integers
  std::string place;              ///< "line N" or a key
};

/// A .log: blocks of a line of three whole numbers and four lines of a 4×4 matrix world_from_camera. Throws
/// IoError.
std::vector<TrajectoryEntry> readLogTrajectory(const std::filesystem::path& path);

/// A PinholeCameraTrajectory as JSON: parameters[] of an extrinsic (4×4 camera_from_world) and an intrinsic,
/// matrices column by column. Throws IoError.
std::vector<TrajectoryEntry> readJsonTrajectory(const std::filesystem::path& path);

/// A PinholeCameraIntrinsic as JSON: width, height, intrinsic_matrix (3×3, column by column). Throws IoError.
Pinhole readOpen3dIntrinsic(const std::filesystem::path& path);

/// The same as text. `trajectory` needs cameras for JSON only.
std::string logTrajectoryText(const std::vector<TrajectoryEntry>& trajectory);
std::string jsonTrajectoryText(const std::vector<TrajectoryEntry>& trajectory);
std::string open3dIntrinsicText(const Pinhole& camera);

}  // namespace vdbfuse
