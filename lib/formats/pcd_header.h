// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse::io {

struct PcdField {
  std::string name;
  std::int64_t size = 0, count = 1;
  std::string type;  ///< F, I or U
};

/// What the header of any PCD file says.
struct PcdLayout {
  std::vector<PcdField> fields;  ///< at least one; sizes and counts from 0 to 65535
  std::int64_t width = 0, height = 0;
  std::int64_t points = 0;  ///< width x height; checked against nothing
  RigidTransform viewpoint = RigidTransform::Identity();
  std::string data;  ///< ascii, binary or binary_compressed
  std::size_t data_begin = 0;
};

/// Throws IoError, with the line, for what is no header of a PCD file.
PcdLayout parsePcdLayout(const std::filesystem::path& path, std::string_view bytes);

/// What the header of an organised PCD file says; it is known to be sound.
struct PcdHeader {
  int width = 0, height = 0;
  RigidTransform viewpoint = RigidTransform::Identity();  ///< world_from_camera
};

/// Throws IoError, with the line, when the header is not that of an organised cloud with x, y, z, when
/// VIEWPOINT is no rigid transform, or when the file is shorter than the header says.
PcdHeader readPcdHeader(const std::filesystem::path& path);

}  // namespace vdbfuse::io
