// SPDX-License-Identifier: Apache-2.0
#include "formats/format_table.h"

#include <algorithm>

namespace vdbfuse {

std::string contentsOf(const std::filesystem::path& path) {
  constexpr std::size_t kShown = 4;
  if (!std::filesystem::is_directory(path)) return "a file of another kind";
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(path, error)) {
    const std::string name = entry.path().filename().string();
    names.push_back(entry.is_directory(error) ? name + "/" : name);
  }
  std::sort(names.begin(), names.end());
  std::string text = names.empty() ? "an empty folder" : "a folder of ";
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > kShown ? text + " and " + std::to_string(names.size() - kShown) + " more" : text;
}

void requireEmptyFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw IoError(folder, "the folder cannot be created: " + error.message());
  if (!std::filesystem::is_empty(folder))
    throw IoError(folder, "", "an empty folder", "one that is not empty");
}

}  // namespace vdbfuse
