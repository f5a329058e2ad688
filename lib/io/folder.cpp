// SPDX-License-Identifier: Apache-2.0
#include "io/folder.h"

#include <algorithm>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

// Runs of digits by value, the rest byte by byte.
bool comesBefore(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty()) {
    if (!isDigit(a[0]) || !isDigit(b[0])) {
      if (a[0] != b[0]) return a[0] < b[0];
      a.remove_prefix(1), b.remove_prefix(1);
      continue;
    }
    const auto take_number = [](std::string_view& text) {
      text.remove_prefix(std::min(text.find_first_not_of('0'), text.size()));
      const std::string_view digits = text.substr(0, text.find_first_not_of("0123456789"));
      text.remove_prefix(digits.size());
      return digits;
    };
    const std::string_view x = take_number(a), y = take_number(b);
    if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
  }
  return a.size() < b.size();
}

}  // namespace

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

std::vector<std::string> filesInOrder(const std::filesystem::path& folder,
                                      std::span<const char* const> suffixes) {
  std::vector<std::string> names;
  for (const char* suffix : suffixes) {
    const std::vector<std::string> found = filesEndingWith(folder, suffix);
    names.insert(names.end(), found.begin(), found.end());
  }
  std::sort(names.begin(), names.end());
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return comesBefore(a, b); });
  return names;
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
