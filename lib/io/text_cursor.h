// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace vdbfuse::io {

/// Walks through the words of a text; every failure is an IoError that names the line. `path` and `text` must
/// outlive the cursor.
class TextCursor {
 public:
  TextCursor(const std::filesystem::path& path, std::string_view text, std::size_t position = 0)
      : path_(path), text_(text), position_(position), word_start_(position) {}

  /// The next word, on this line or a later one; empty at the end of the text.
  std::string_view word();
  /// The next word of this line; empty at its end.
  std::string_view wordOnLine();
  /// The rest of this line, without its end; then stands on the next line.
  std::string_view restOfLine();
  bool atEnd() const { return position_ >= text_.size(); }
  std::size_t position() const { return position_; }

  /// The next word as a number. IoError when it is none.
  double number();
  double numberOnLine();
  /// The next word as a finite number. IoError when it is none.
  double finite();
  /// The next word as a whole number in [0, most]. IoError when it is none.
  std::int64_t whole(std::int64_t most);
  /// "line N" of the last word read.
  std::string place() const;
  /// Throws an IoError at the last word read, which was `found`; empty means that line or text ended.
  [[noreturn]] void fail(const std::string& expected, std::string_view found) const;
  /// The same with a description of what was found.
  [[noreturn]] void failWith(const std::string& expected, const std::string& description) const;

 private:
  double parse(std::string_view word) const;
  std::string_view take();

  const std::filesystem::path& path_;
  std::string_view text_;
  std::size_t position_;
  std::size_t word_start_;
};

/// The whole of `word` as an integer.
std::optional<std::int64_t> parseInteger(std::string_view word);

}  // namespace vdbfuse::io
