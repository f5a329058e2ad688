// SPDX-License-Identifier: Apache-2.0
#include "formats/xyz_text.h"

#include <algorithm>
#include <charconv>
#include <string>

#include "io/file_bytes.h"
#include "io/text_cursor.h"

namespace vdbfuse::io {
namespace {

std::string withBlanks(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  return text;
}

bool isNumber(std::string_view word) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

// Numbers on the line where a copy of the cursor stands, counted up to the first word that is none.
std::size_t numbersAhead(TextCursor cursor) {
  std::size_t count = 0;
  while (isNumber(cursor.wordOnLine())) ++count;
  return count;
}

bool isRemark(TextCursor cursor) {
  const std::string_view word = cursor.wordOnLine();
  return word.empty() || word.starts_with('#') || word.starts_with("//");
}

// To the first line of data.
void passHeading(TextCursor& cursor) {
  while (!cursor.atEnd() && isRemark(cursor)) cursor.restOfLine();
  TextCursor ahead = cursor;
  const bool is_count = numbersAhead(cursor) == 1 && (ahead.wordOnLine(), ahead.wordOnLine().empty());
  if (numbersAhead(cursor) == 0 || is_count) cursor.restOfLine();
}

}  // namespace

std::vector<double> readXyzText(const std::filesystem::path& path, std::size_t columns) {
  const std::string text = withBlanks(readFileBytes(path));
  TextCursor cursor(path, text);
  std::vector<double> numbers;
  for (passHeading(cursor); !cursor.atEnd(); cursor.restOfLine()) {
    if (isRemark(cursor)) continue;
    for (std::size_t c = 0; c < columns; ++c) numbers.push_back(cursor.numberOnLine());
  }
  return numbers;
}

std::size_t xyzColumns(const std::filesystem::path& path, std::string_view start) {
  const std::string text = withBlanks(std::string(start));
  TextCursor cursor(path, text);
  for (passHeading(cursor); !cursor.atEnd(); cursor.restOfLine()) {
    if (!isRemark(cursor)) return numbersAhead(cursor) >= 3 ? numbersAhead(cursor) : 0;
  }
  return 0;
}

}  // namespace vdbfuse::io
