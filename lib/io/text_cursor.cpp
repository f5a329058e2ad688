// SPDX-License-Identifier: Apache-2.0
#include "text_cursor.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

constexpr std::string_view kBlank = " \t\r\v\f";
constexpr std::string_view kSpace = " \t\r\v\f\n";
constexpr std::size_t kLongestShown = 40;

}  // namespace

std::string_view TextCursor::take() {
  word_start_ = position_;
  position_ = std::min(text_.find_first_of(kSpace, position_), text_.size());
  return text_.substr(word_start_, position_ - word_start_);
}

std::string_view TextCursor::word() {
  position_ = std::min(text_.find_first_not_of(kSpace, position_), text_.size());
  return take();
}

std::string_view TextCursor::wordOnLine() {
  position_ = std::min(text_.find_first_not_of(kBlank, position_), text_.size());
  return take();
}

std::string_view TextCursor::restOfLine() {
  word_start_ = position_;
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  std::string_view rest = text_.substr(position_, end - position_);
  position_ = std::min(end + 1, text_.size());
  while (!rest.empty() && kBlank.find(rest.back()) != kBlank.npos) rest.remove_suffix(1);
  return rest;
}

double TextCursor::number() { return parse(word()); }
double TextCursor::numberOnLine() { return parse(wordOnLine()); }

double TextCursor::finite() {
  const std::string_view text = word();
  const double value = parse(text);
  if (!std::isfinite(value)) fail("a finite number", text);
  return value;
}

std::int64_t TextCursor::whole(std::int64_t most) {
  const std::string_view text = word();
  const std::optional<std::int64_t> value = parseInteger(text);
  if (!value || *value < 0 || *value > most) fail("a whole number from 0 to " + std::to_string(most), text);
  return *value;
}

double TextCursor::parse(std::string_view word) const {
  const std::string_view digits = !word.empty() && word.front() == '+' ? word.substr(1) : word;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size()) fail("a number", word);
  return value;
}

void TextCursor::fail(const std::string& expected, std::string_view found) const {
  if (!found.empty()) failWith(expected, "'" + std::string(found.substr(0, kLongestShown)) + "'");
  failWith(expected, word_start_ >= text_.size() ? "the end of the file" : "the end of the line");
}

std::string TextCursor::place() const {
  const auto line =
      1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(word_start_), '\n');
  return "line " + std::to_string(line);
}

void TextCursor::failWith(const std::string& expected, const std::string& description) const {
  throw IoError(path_, place(), expected, description);
}

std::optional<std::int64_t> parseInteger(std::string_view word) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace vdbfuse::io
