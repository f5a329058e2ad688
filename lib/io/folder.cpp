// SPDX-License-Identifier: Apache-2.0
#include "io/folder.h"

#include <algorithm>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {

std::vector<std::string> filesEndingWith(const std::filesystem::path& folder, std::string_view suffix) {
  std::vector<std::string> names;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return names;
  std::filesystem::directory_iterator entry(folder, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    std::error_code ignored;
    // Hidden files are what an interrupted writer or a foreign file system left behind.
    if (name.size() > suffix.size() && name.front() != '.' && name.ends_with(suffix) &&
        entry->is_regular_file(ignored))
      names.push_back(std::move(name));
  }
  if (error) throw IoError(folder, "the folder cannot be read: " + error.message());
  std::sort(names.begin(), names.end());
  return names;
}

bool isFile(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

std::filesystem::path findPicture(const std::filesystem::path& folder, const std::string& stem) {
  for (const char* extension : {".png", ".jpg", ".jpeg"}) {
    std::filesystem::path candidate = folder / (stem + extension);
    if (isFile(candidate)) return candidate;
  }
  return {};
}

std::filesystem::path pathInside(const std::filesystem::path& folder, const std::string& relative,
                                 const std::filesystem::path& named_in, const std::string& place) {
  const std::filesystem::path path = std::filesystem::path(relative).lexically_normal();
  const bool holds_zero = relative.find('\0') != std::string::npos;
  if (relative.empty() || path.is_absolute() || *path.begin() == ".." || holds_zero)
    throw IoError(named_in, place, "a path inside the data set",
                  "'" + relative.substr(0, std::min(relative.find('\0'), std::size_t{100})) + "'");
  return folder / path;
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace vdbfuse
