// SPDX-License-Identifier: Apache-2.0
// The exceptions of the library. "No answer" is never an exception: it is a std::optional or a field of a
// result.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace vdbfuse {

/// Base of everything the library throws on purpose.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A caller broke a contract. The message begins with the name of the argument.
class InvalidArgument : public Error {
 public:
  InvalidArgument(const std::string& argument, const std::string& what_is_wrong);
};

/// A file cannot be read or written. The message is one line: path, place, expected, found.
class IoError : public Error {
 public:
  /// `place` is empty, "line N" or "byte N".
  IoError(const std::filesystem::path& path, const std::string& place, const std::string& expected,
          const std::string& found);
  /// For failures that have no place in the file: "PATH: MESSAGE".
  IoError(const std::filesystem::path& path, const std::string& message);
};

/// The progress callback asked to stop.
class Cancelled : public Error {
 public:
  Cancelled();
};

}  // namespace vdbfuse
