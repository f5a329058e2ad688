// SPDX-License-Identifier: Apache-2.0
#include "io/npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "io/file_bytes.h"
#include "io/image_size.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

static_assert(std::endian::native == std::endian::little);

namespace fs = std::filesystem;
constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kLongestHeader = 64 * 1024;
constexpr std::size_t kMostDimensions = 8;

template <class T>
T swapped(T value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  std::reverse(raw.begin(), raw.end());
  return std::bit_cast<T>(raw);
}

template <class T>
double numberAt(const char* bytes, bool swap) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(swap ? swapped(value) : value);
}

// IEEE 754 half precision.
double halfAt(const char* bytes, bool swap) {
  std::uint16_t raw;
  std::memcpy(&raw, bytes, sizeof raw);
  if (swap) raw = swapped(raw);
  const int exponent = (raw >> 10) & 31, fraction = raw & 1023;
  double value = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  if (exponent == 31)
    value =
        fraction == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
  return raw & 0x8000 ? -value : value;
}

// The header's dictionary, which numpy writes as {'descr': '<f4', 'fortran_order': False, 'shape': (3, 4), }.
class Dictionary {
 public:
  Dictionary(const fs::path& path, std::string place, std::string_view text)
      : path_(path), place_(std::move(place)), text_(text) {}

  std::string_view quoted(std::string_view key) const {
    std::string_view rest = after(key);
    if (rest.empty() || (rest[0] != '\'' && rest[0] != '"'))
      fail("a numpy array of numbers", "a structured one");
    const std::size_t end = rest.find(rest[0], 1);
    if (end == rest.npos) fail("a numpy header", "an open quotation");
    return rest.substr(1, end - 1);
  }

  bool truth(std::string_view key) const {
    const std::string_view rest = after(key);
    if (rest.starts_with("True")) return true;
    if (!rest.starts_with("False")) fail("True or False after " + std::string(key), "something else");
    return false;
  }

  std::vector<std::int64_t> tuple(std::string_view key) const {
    std::string_view rest = after(key);
    const std::size_t end = rest.find(')');
    if (rest.empty() || rest[0] != '(' || end == rest.npos) fail("a shape (N, M)", "something else");
    rest = rest.substr(1, end - 1);
    std::vector<std::int64_t> numbers;
    while (true) {
      rest.remove_prefix(std::min(rest.find_first_not_of(" ,L"), rest.size()));
      if (rest.empty()) return numbers;
      std::int64_t value = 0;
      const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
      if (error != std::errc{} || value < 0 || numbers.size() == kMostDimensions)
        fail("a shape of up to 8 whole numbers", "'" + std::string(rest.substr(0, 20)) + "'");
      numbers.push_back(value);
      rest.remove_prefix(static_cast<std::size_t>(stop - rest.data()));
    }
  }

  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw IoError(path_, place_, expected, found);
  }

 private:
  std::string_view after(std::string_view key) const {
    std::size_t at = text_.find("'" + std::string(key) + "'");
    if (at != text_.npos) at = text_.find(':', at);
    if (at == text_.npos) fail("a numpy header with " + std::string(key), "none");
    std::string_view rest = text_.substr(at + 1);
    rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
    return rest;
  }

  const fs::path& path_;
  std::string place_;
  std::string_view text_;
};

void setNumber(const Dictionary& dictionary, NpyHeader& header) {
  const std::string_view descr = dictionary.quoted("descr");
  const auto is_one_of = [](char c, std::string_view all) { return all.find(c) != all.npos; };
  const bool known = descr.size() == 3 && is_one_of(descr[0], "<>|=") && is_one_of(descr[1], "fiub") &&
                     is_one_of(descr[2], "1248");
  if (known) {
    header.kind = descr[1];
    header.bytes = descr[2] - '0';
    header.big_endian = descr[0] == '>';
  }
  if (!known || (header.kind == 'f' && header.bytes == 1) || (header.kind == 'b' && header.bytes != 1))
    dictionary.fail("floats or whole numbers of up to 8 bytes", "'" + std::string(descr.substr(0, 20)) + "'");
}

std::string_view dictionaryText(const fs::path& path, const std::string& place, std::string_view bytes,
                                std::size_t& data_begin) {
  const auto fail = [&](const std::string& expected, const std::string& found) {
    throw IoError(path, place, expected, found);
  };
  if (!bytes.starts_with(kMagic)) fail("a numpy array (.npy)", "something else");
  const bool is_long = bytes.size() > 6 && bytes[6] >= 2;
  const std::size_t begin = is_long ? 12 : 10;
  if (bytes.size() < begin) fail("a numpy header", "the end of the file");
  if (bytes[6] < 1 || bytes[6] > 3) fail("a numpy array of version 1 to 3", std::to_string(bytes[6]));
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, is_long ? 4 : 2);
  if (length > kLongestHeader || bytes.size() - begin < length)
    fail("a numpy header of " + std::to_string(length) + " bytes", "the end of the file");
  data_begin = begin + length;
  return bytes.substr(begin, length);
}

// Width and height of what is an image; the other dimensions are 1.
std::pair<int, int> imageSize(const fs::path& path, const NpyHeader& header) {
  std::vector<std::int64_t> sides;
  for (const std::int64_t side : header.shape) {
    if (side != 1 || header.shape.size() == 2) sides.push_back(side);
  }
  if (sides.size() != 2)
    throw IoError(path, "", "an array of rows and columns", "shape " + header.shapeText());
  checkImageSize(path, "", sides[1], sides[0]);
  return {static_cast<int>(sides[1]), static_cast<int>(sides[0])};
}

RasterHeader rasterHeader(const fs::path& path, const NpyHeader& header) {
  const auto [width, height] = imageSize(path, header);
  RasterHeader result{RasterKind::Npy, width, height, 8 * header.bytes, RasterHeader::Number::Unsigned};
  if (header.kind == 'f') result.number = RasterHeader::Number::Float;
  if (header.kind == 'i') result.number = RasterHeader::Number::Signed;
  return result;
}

}  // namespace

std::size_t NpyHeader::count() const {
  std::size_t product = 1;
  for (const std::int64_t side : shape) product *= static_cast<std::size_t>(side);
  return product;
}

std::string NpyHeader::shapeText() const {
  std::string text;
  for (const std::int64_t side : shape) text += (text.empty() ? "" : ", ") + std::to_string(side);
  return "(" + text + ")";
}

double NpyArray::operator[](std::size_t index) const {
  const char* at = bytes.data() + index * static_cast<std::size_t>(header.bytes);
  const bool swap = header.big_endian;
  if (header.kind == 'f') {
    if (header.bytes == 2) return halfAt(at, swap);
    return header.bytes == 4 ? numberAt<float>(at, swap) : numberAt<double>(at, swap);
  }
  if (header.kind == 'i') {
    switch (header.bytes) {
      case 1:
        return numberAt<std::int8_t>(at, swap);
      case 2:
        return numberAt<std::int16_t>(at, swap);
      case 4:
        return numberAt<std::int32_t>(at, swap);
      default:
        return numberAt<std::int64_t>(at, swap);
    }
  }
  switch (header.bytes) {
    case 1:
      return numberAt<std::uint8_t>(at, swap);
    case 2:
      return numberAt<std::uint16_t>(at, swap);
    case 4:
      return numberAt<std::uint32_t>(at, swap);
    default:
      return numberAt<std::uint64_t>(at, swap);
  }
}

NpyHeader parseNpyHeader(const fs::path& path, const std::string& place, std::string_view bytes,
                         std::uint64_t size) {
  NpyHeader header;
  const Dictionary dictionary(path, place, dictionaryText(path, place, bytes, header.data_begin));
  setNumber(dictionary, header);
  header.fortran_order = dictionary.truth("fortran_order");
  header.shape = dictionary.tuple("shape");
  const std::uint64_t room = (size - header.data_begin) / static_cast<std::uint64_t>(header.bytes);
  std::uint64_t count = 1;
  for (const std::int64_t side : header.shape) {
    const auto s = static_cast<std::uint64_t>(side);
    if (s != 0 && count > room / s)
      dictionary.fail("as many numbers as the shape " + header.shapeText() + " has", "the end of the file");
    count *= s;
  }
  return header;
}

NpyArray readNpy(const fs::path& path) {
  std::string bytes = readFileBytes(path);
  NpyArray array{parseNpyHeader(path, "", bytes, bytes.size()), {}};
  bytes.erase(0, array.header.data_begin);
  array.bytes = std::move(bytes);
  return array;
}

Image<float> npyImage(const NpyArray& array, std::size_t first, int width, int height) {
  Image<float> image(width, height);
  for (float& value : image) value = static_cast<float>(array[first++]);
  return image;
}

RasterHeader readNpyRasterHeader(const fs::path& path) {
  return rasterHeader(path, parseNpyHeader(path, "", readFileStart(path, kLongestHeader), fileSize(path)));
}

Image<float> readNpyRaster(const fs::path& path) {
  const NpyArray array = readNpy(path);
  const auto [width, height] = imageSize(path, array.header);
  if (!array.header.fortran_order) return npyImage(array, 0, width, height);
  Image<float> image(width, height);
  std::size_t next = 0;
  for (int x = 0; x < width; ++x) {
    for (int y = 0; y < height; ++y) image(x, y) = static_cast<float>(array[next++]);
  }
  return image;
}

std::string formatNpyHeader(const std::string& descr, const std::vector<std::int64_t>& shape) {
  std::string dictionary = "{'descr': '" + descr + "', 'fortran_order': False, 'shape': (";
  for (const std::int64_t side : shape) dictionary += std::to_string(side) + ", ";
  dictionary += "), }";
  constexpr std::size_t kAlignment = 64;
  while ((10 + dictionary.size() + 1) % kAlignment != 0) dictionary += ' ';
  dictionary += '\n';
  const auto length = static_cast<std::uint16_t>(dictionary.size());
  std::string text(kMagic);
  text += std::string("\x01\x00", 2);
  text.append(reinterpret_cast<const char*>(&length), sizeof length);
  return text + dictionary;
}

std::string formatNpy(const std::vector<std::int64_t>& shape, const std::vector<double>& values, int bytes) {
  std::string text = formatNpyHeader("<f" + std::to_string(bytes), shape);
  for (const double value : values) {
    const auto single = static_cast<float>(value);
    const void* number = bytes == 4 ? static_cast<const void*>(&single) : &value;
    text.append(static_cast<const char*>(number), static_cast<std::size_t>(bytes));
  }
  return text;
}

}  // namespace vdbfuse::io
