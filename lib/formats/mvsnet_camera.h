// SPDX-License-Identifier: Apache-2.0
// The camera files of the MVSNet layout.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse {

/// What a camera file holds. The size of the camera is not in it: width and height are 0.
struct MvsnetCamera {
  RigidTransform world_from_camera = RigidTransform::Identity();
  Pinhole pinhole;
  std::string intrinsics_place;  ///< "line N", for messages
  /// Of the last line: smallest depth, interval, number of intervals (192 where it is missing) and largest
  /// depth (else what they reach). Not checked.
  DepthInterval depths;
};

/// Throws IoError.
MvsnetCamera readMvsnetCamera(const std::filesystem::path& path);

struct FittedCamera {
  Pinhole pinhole;
  double scale = 1.0;  ///< what the intrinsics were multiplied by
};

/// The camera for a depth map (or picture) of the given size. Kept as it is when its principal point lies
/// roughly in the middle of the depth map in at least one direction; else scaled by the ratio of depth map to
/// picture, or by the nearest power of two, where that puts the principal point into the middle; else kept
/// when the principal point lies inside the depth map (a crop), and nothing when it lies outside.
std::optional<FittedCamera> fitToDepthMap(const Pinhole& camera, const PfmHeader& depth_map,
                                          std::optional<double> depth_per_picture);

/// The text of a camera file.
std::string mvsnetCameraText(const Pinhole& camera, const RigidTransform& world_from_camera, double min_depth,
                             double max_depth);

}  // namespace vdbfuse
