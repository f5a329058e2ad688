// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace vdbfuse::test {

/// As scripts for instant-ngp write it: cameras of an angle, no sizes, depth_path, 16-bit PNG of
/// integer_depth_scale.
void writeInstantNgpSample(const std::filesystem::path& folder);
/// As nerfstudio has it: cameras of every frame, of pictures twice as large as the depth maps, which are NPY.
void writeNerfstudioSample(const std::filesystem::path& folder);

}  // namespace vdbfuse::test
