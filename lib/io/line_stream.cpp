// SPDX-License-Identifier: Apache-2.0
#include "io/line_stream.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

constexpr std::size_t kChunk = 1 << 20;
constexpr std::size_t kLongestLine = 1 << 16;

}  // namespace

LineStream::LineStream(const std::filesystem::path& path, std::uint64_t offset, std::uint64_t line)
    : path_(path), file_size_(fileSize(path)), buffer_start_(offset), number_(line - 1) {
  file_.open(path, std::ios::binary);
  file_.seekg(static_cast<std::streamoff>(offset));
  if (!file_ || offset > file_size_) throw IoError(path, "cannot be read");
}

// Puts the next part of the file behind what is left of this one.
bool LineStream::fill() {
  buffer_.erase(0, begin_);
  buffer_start_ += begin_;
  begin_ = 0;
  const std::size_t kept = buffer_.size();
  buffer_.resize(kept + kChunk);
  file_.read(buffer_.data() + kept, kChunk);
  buffer_.resize(kept + static_cast<std::size_t>(file_.gcount()));
  // A file that grows while it is read.
  file_size_ = std::max(file_size_, buffer_start_ + buffer_.size());
  return buffer_.size() > kept;
}

bool LineStream::next() {
  std::size_t end = buffer_.find('\n', begin_);
  if (end == buffer_.npos && fill()) end = buffer_.find('\n', begin_);
  if (begin_ == buffer_.size()) return false;
  ++number_;
  const std::size_t length = std::min(end, buffer_.size()) - begin_;
  if (length > kLongestLine)
    throw IoError(path_, place(), "a line of text", "more than 65536 bytes without an end of line");
  text_ = std::string_view(buffer_).substr(begin_, length);
  if (!text_.empty() && text_.back() == '\r') text_.remove_suffix(1);
  begin_ = std::min(begin_ + length + 1, buffer_.size());
  return true;
}

double takeNumber(std::string_view& text) {
  const std::size_t start = std::min(text.find_first_not_of(" \t"), text.size());
  const char* begin = text.data() + start;
  const char* end = text.data() + text.size();
  if (begin + 1 < end && *begin == '+') ++begin;
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  const bool is_whole = stop == end || *stop == ' ' || *stop == '\t';
  if (error != std::errc() || !is_whole) return std::numeric_limits<double>::quiet_NaN();
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return value;
}

}  // namespace vdbfuse::io
