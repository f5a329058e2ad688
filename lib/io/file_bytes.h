// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace vdbfuse::io {

/// All bytes of a regular file. IoError when there is none or it cannot be read.
std::string readFileBytes(const std::filesystem::path& path);

/// The first `count` bytes, or all where there are fewer. IoError as above.
std::string readFileStart(const std::filesystem::path& path, std::size_t count);

/// Bytes [offset, offset + count). IoError as above, or when there are fewer.
std::string readFilePart(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t count);

/// Bytes in a regular file. IoError as above.
std::uint64_t fileSize(const std::filesystem::path& path);

/// Puts `bytes` in place of the file, complete or not at all. Throws IoError.
void writeFileBytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace vdbfuse::io
