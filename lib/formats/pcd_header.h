// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse::io {

/// What the header of an organised PCD file says; it is known to be sound.
struct PcdHeader {
  int width = 0, height = 0;
  RigidTransform viewpoint = RigidTransform::Identity();  ///< world_from_camera
};

/// Throws IoError, with the line, when the header is not that of an organised cloud with x, y, z, when
/// VIEWPOINT is no rigid transform, or when the file is shorter than the header says.
PcdHeader readPcdHeader(const std::filesystem::path& path);

}  // namespace vdbfuse::io
