// SPDX-License-Identifier: Apache-2.0
// Silhouette masks beside a data set of any format.
#pragma once

#include <filesystem>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {

/// Gives each view its mask: FOLDER/NAME.png where `folder` is given, one for every view; else masks/NAME.png
/// or NAME.mask.png in the data set, where there is one, and a note says how many. Sizes are checked now,
/// pixels read when the view is loaded. Throws IoError.
void addMasks(DepthSet& set, const std::filesystem::path& data, const std::filesystem::path& folder);

}  // namespace vdbfuse
