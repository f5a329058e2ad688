// SPDX-License-Identifier: Apache-2.0
// What the core library calls in the PCL part after opening it at run time: one function, looked up by name.
#pragma once

#include <filesystem>

#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {

/// Sets `points` to those of an organised PCD file, as stored. REQUIRES: its header is sound. Throws IoError.
/// (No return value, because a function that is found by name has C linkage.)
using ReadPcdPoints = void(const std::filesystem::path& path, PointImage& points);

inline constexpr const char* kReadPcdPointsSymbol = "vdbfuse_read_pcd_points";

}  // namespace vdbfuse
