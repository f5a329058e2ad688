// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace vdbfuse {

/// Throws IoError unless 1 ≤ width·height ≤ 2^28: no header makes us take memory beyond reason.
void checkImageSize(const std::filesystem::path& path, const std::string& place, std::int64_t width,
                    std::int64_t height);

/// "640x480".
std::string sizeText(std::int64_t width, std::int64_t height);

}  // namespace vdbfuse
