// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace vdbfuse::test {

/// A folder of the real data ($VDBFUSE_DATA, else ../shared/data); nothing where it is absent.
inline std::optional<std::filesystem::path> sharedData(const std::string& name) {
  const char* told = std::getenv("VDBFUSE_DATA");
  const std::filesystem::path path =
      std::filesystem::path(told != nullptr ? told : VDBFUSE_SHARED_DATA) / name;
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return std::nullopt;
  return path;
}

}  // namespace vdbfuse::test
