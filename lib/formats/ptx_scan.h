// SPDX-License-Identifier: Apache-2.0
// The scans in one PTX file: where they begin, and their points.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"
#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {

struct PtxScan {
  std::filesystem::path path;
  int columns = 0, rows = 0;
  RigidTransform world_from_points = RigidTransform::Identity();  ///< the 4×4 matrix
  /// Position and axes of the scanner; none when these are no rotation.
  std::optional<RigidTransform> world_from_scanner;
  std::uint64_t first_byte = 0, first_line = 0;  ///< of the points
  bool has_color = false;
};

/// Throws IoError when there is no scan, a header is unsound or the file ends too early.
std::vector<PtxScan> indexPtx(const std::filesystem::path& path);

/// The points as an upright image in the axes `camera_from_points` leads to. Throws IoError.
PointImage readPtxPoints(const PtxScan& scan, const RigidTransform& camera_from_points);

}  // namespace vdbfuse
