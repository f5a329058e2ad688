// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse::io {

/// The points of an organised PCD file, as stored, in any of its encodings; by the library vdbfuse_pcl, which
/// lies beside this one and is opened at the first call. REQUIRES: the header is sound. Throws IoError, also
/// when the library is missing.
PointImage readPcdPoints(const std::filesystem::path& path);

}  // namespace vdbfuse::io
