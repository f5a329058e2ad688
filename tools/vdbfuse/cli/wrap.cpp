// SPDX-License-Identifier: Apache-2.0
#include "cli/wrap.h"

#include <sstream>

namespace vdbfuse::tool {
namespace {

// Letters, not the bytes of UTF-8.
std::size_t columnsOf(const std::string& word) {
  std::size_t columns = 0;
  for (const char c : word) columns += (static_cast<unsigned char>(c) & 0xc0) != 0x80 ? 1 : 0;
  return columns;
}

}  // namespace

std::string wrap(const std::string& text, std::size_t width, std::size_t indent) {
  const std::string margin(indent, ' ');
  std::string result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!result.empty()) result += "\n" + (line.empty() ? "" : margin);
    std::size_t used = 0;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const std::size_t columns = columnsOf(word);
      const bool breaks = used > 0 && used + 1 + columns > width;
      if (breaks) result += "\n" + margin, used = 0;
      result += (used > 0 ? " " : "") + word;
      used += (used > 0 ? 1 : 0) + columns;
    }
  }
  return result;
}

}  // namespace vdbfuse::tool
