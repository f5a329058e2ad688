// SPDX-License-Identifier: Apache-2.0
// Silhouette masks beside a data set of any format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Gives each view its mask: FOLDER/NAME.png where `folder` is given, one for every view; else masks/NAME.png
/// or NAME.mask.png in the data set, where there is one, and a note says how many. Sizes are checked now,
/// pixels read when the view is loaded. Throws IoError.
void addMasks(DepthSet& set, const std::filesystem::path& data, const std::filesystem::path& folder);

/// Of each name FOLDER/NAME.png where `folder` is given; else masks/NAME.png or NAME.mask.png in the data
/// set, empty where there is none. Throws IoError when `folder` lacks one.
std::vector<std::filesystem::path> maskPaths(const std::vector<std::string>& names,
                                             const std::filesystem::path& data,
                                             const std::filesystem::path& folder);

/// Throws IoError unless it is a PNG of at most 8 bits and of that size, which is that of the `image`:
/// "depth map".
void checkMask(const std::filesystem::path& path, int width, int height, const std::string& image);

/// 255 where the PNG is not black. Throws IoError.
Image<std::uint8_t> readMask(const std::filesystem::path& path);

}  // namespace vdbfuse
