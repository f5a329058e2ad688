// SPDX-License-Identifier: Apache-2.0
// Whole files in memory, with the errors that every reader shares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace vdbfuse {

/// The first `limit` bytes of a file, or all of it. Throws IoError when it is absent, a folder or unreadable.
std::vector<unsigned char> readFileBytes(const std::filesystem::path& path,
                                         std::size_t limit = std::numeric_limits<std::size_t>::max());

/// Size of a regular file. Throws IoError as readFileBytes() does.
std::uint64_t fileBytes(const std::filesystem::path& path);

/// Writes a file that is complete or absent. Throws IoError.
void writeFileBytes(const std::filesystem::path& path, std::span<const unsigned char> bytes);

/// Throws IoError unless 1 ≤ width·height ≤ 2^28: no header makes us take memory beyond reason.
void checkImageSize(const std::filesystem::path& path, const std::string& place, std::int64_t width,
                    std::int64_t height);

/// "640x480".
std::string sizeText(std::int64_t width, std::int64_t height);

}  // namespace vdbfuse
