// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

std::string describe(const std::filesystem::path& path, const std::string& place, const std::string& expected,
                     const std::string& found) {
  const std::string where = place.empty() ? path.string() : path.string() + ": " + place;
  std::string text = where + ": expected " + expected + ", found " + found;
  // What was found may come from the file as it is; the message is one line.
  for (char& c : text) c = c == '\n' || c == '\r' ? ' ' : c;
  return text;
}

}  // namespace

InvalidArgument::InvalidArgument(const std::string& argument, const std::string& what_is_wrong)
    : Error(argument + ": " + what_is_wrong) {}

IoError::IoError(const std::filesystem::path& path, const std::string& place, const std::string& expected,
                 const std::string& found)
    : Error(describe(path, place, expected, found)) {}

IoError::IoError(const std::filesystem::path& path, const std::string& message)
    : Error(path.string() + ": " + message) {}

Cancelled::Cancelled() : Error("cancelled") {}

}  // namespace vdbfuse
