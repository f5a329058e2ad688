// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace vdbfuse::tool {

/// Writes these bytes, where nobody minds half a file: a temporary one, or one in a folder that is not in its
/// place yet. Throws IoError that says why, and calls the file `name`.
void writeText(const std::filesystem::path& path, const std::string& text, const std::filesystem::path& name);
inline void writeText(const std::filesystem::path& path, const std::string& text) {
  writeText(path, text, path);
}

/// Writes these bytes; the file is complete or absent. Throws IoError.
void replaceText(const std::filesystem::path& path, const std::string& text);

}  // namespace vdbfuse::tool
