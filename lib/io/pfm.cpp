// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/pfm.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "io/file_bytes.h"
#include "io/image_size.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

// "Pf", two sizes and a scale fit well into this.
constexpr std::size_t kMaxHeaderBytes = 256;

struct Layout {
  PfmHeader header;
  std::endian order = std::endian::little;
  std::size_t first_byte = 0;  // of the pixels
};

// Words of a header, one after the other.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view next() {
    while (position_ < text_.size() && isSpace(text_[position_])) ++position_;
    begin_ = position_;
    while (position_ < text_.size() && !isSpace(text_[position_])) ++position_;
    return text_.substr(begin_, position_ - begin_);
  }
  std::string place() const { return "byte " + std::to_string(begin_); }
  std::size_t position() const { return position_; }

 private:
  static bool isSpace(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }
  std::string_view text_;
  std::size_t begin_ = 0, position_ = 0;
};

template <class T>
std::optional<T> number(std::string_view word) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::string quoted(std::string_view word) { return word.empty() ? "nothing" : "'" + std::string(word) + "'"; }

std::int64_t readSize(const std::filesystem::path& path, Words& words, const char* expected) {
  const std::string_view word = words.next();
  const std::optional<std::int64_t> size = number<std::int64_t>(word);
  if (!size || *size <= 0) throw IoError(path, words.place(), expected, quoted(word));
  return *size;
}

Layout parseHeader(const std::filesystem::path& path, std::string_view text) {
  Words words(text);
  const std::string_view magic = words.next();
  if (magic == "PF") throw IoError(path, "byte 0", "a grey PFM file ('Pf')", "a colour one ('PF')");
  if (magic != "Pf") throw IoError(path, "byte 0", "a PFM file ('Pf')", "another signature");
  const std::int64_t width = readSize(path, words, "a width above 0");
  const std::string place = words.place();
  const std::int64_t height = readSize(path, words, "a height above 0");
  checkImageSize(path, place, width, height);
  const std::string_view word = words.next();
  const std::optional<double> scale = number<double>(word);
  if (!scale || !std::isfinite(*scale) || *scale == 0) {
    throw IoError(path, words.place(), "a scale other than 0, its sign the byte order", quoted(word));
  }
  return {{static_cast<int>(width), static_cast<int>(height)},
          *scale < 0 ? std::endian::little : std::endian::big,
          words.position() + 1};
}

Layout readLayout(const std::filesystem::path& path) {
  const std::uint64_t size = io::fileSize(path);
  const Layout layout = parseHeader(path, io::readFileStart(path, kMaxHeaderBytes));
  const auto [width, height] = layout.header;
  const std::uint64_t promised = layout.first_byte + std::uint64_t{4} * static_cast<std::uint64_t>(width) *
                                                         static_cast<std::uint64_t>(height);
  if (size < promised) {
    throw IoError(path, "byte " + std::to_string(size),
                  std::to_string(promised) + " bytes for " + sizeText(width, height) + " pixels",
                  "the end of the file");
  }
  return layout;
}

float swapped(float value) {
  return std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
}

}  // namespace

PfmHeader readPfmHeader(const std::filesystem::path& path) { return readLayout(path).header; }

Image<float> readPfm(const std::filesystem::path& path) {
  const Layout layout = readLayout(path);
  const std::string bytes = io::readFileBytes(path);
  Image<float> image(layout.header.width, layout.header.height);
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(image.width());
  if (bytes.size() < layout.first_byte + row_bytes * static_cast<std::size_t>(image.height()))
    throw IoError(path, "changed while it was read");
  const char* source = bytes.data() + layout.first_byte;
  for (int y = image.height() - 1; y >= 0; --y, source += row_bytes)
    std::memcpy(image.row(y), source, row_bytes);
  if (layout.order != std::endian::native) {
    for (float& value : image) value = swapped(value);
  }
  return image;
}

void writePfm(const std::filesystem::path& path, const Image<float>& image) {
  static_assert(std::endian::native == std::endian::little);
  if (image.empty()) throw InvalidArgument("image", "an empty image cannot be written as PFM");
  std::string bytes =
      "Pf\n" + std::to_string(image.width()) + " " + std::to_string(image.height()) + "\n-1.0\n";
  const std::size_t row_bytes = sizeof(float) * static_cast<std::size_t>(image.width());
  bytes.reserve(bytes.size() + row_bytes * static_cast<std::size_t>(image.height()));
  for (int y = image.height() - 1; y >= 0; --y)
    bytes.append(reinterpret_cast<const char*>(image.row(y)), row_bytes);
  io::writeFileBytes(path, bytes);
}

}  // namespace vdbfuse
