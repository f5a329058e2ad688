// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace vdbfuse::io {

/// A text file of any length, line by line, a megabyte of it in memory. `path` must outlive the stream.
class LineStream {
 public:
  /// Begins at byte `offset`, which is in line `line`. Throws IoError when the file cannot be read.
  explicit LineStream(const std::filesystem::path& path, std::uint64_t offset = 0, std::uint64_t line = 1);

  /// Goes to the next line; false at the end of the file. Throws IoError when the line is longer than 64 kB:
  /// then this is no text.
  bool next();
  /// The line without its end, valid until the next call of next().
  std::string_view text() const { return text_; }
  std::uint64_t number() const { return number_; }
  /// "line N".
  std::string place() const { return "line " + std::to_string(number_); }
  /// Byte in the file behind the line.
  std::uint64_t position() const { return buffer_start_ + begin_; }
  std::uint64_t bytesLeft() const { return file_size_ - position(); }

 private:
  bool fill();

  const std::filesystem::path& path_;
  std::ifstream file_;
  std::uint64_t file_size_;
  std::string buffer_;
  std::uint64_t buffer_start_;
  std::size_t begin_ = 0;
  std::uint64_t number_;
  std::string_view text_;
};

/// The number at the beginning of `text`, blanks before it skipped, and `text` becomes what follows it. NaN
/// with an unchanged `text` when there is none.
double takeNumber(std::string_view& text);

}  // namespace vdbfuse::io
