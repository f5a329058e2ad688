// SPDX-License-Identifier: Apache-2.0
// The values of a PLY file after its header, one after the other, for readers of meshes and of tables.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include "ply_header.h"
#include "text_cursor.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {

/// The values as numbers, from text. `path` and `bytes` must outlive it.
class TextValues {
 public:
  TextValues(const std::filesystem::path& path, std::string_view bytes, const PlyHeader& header)
      : cursor_(path, bytes, header.data_begin), size_(bytes.size()) {}

  double next(PlyType) { return cursor_.number(); }
  std::size_t remaining() const { return size_ - cursor_.position(); }
  // A digit and what separates it from the next; the very last value needs no separator.
  static std::size_t smallest(PlyType) { return 2; }
  std::size_t mayHold() const { return remaining() + 1; }
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    cursor_.failWith(expected, found);
  }

 private:
  TextCursor cursor_;
  std::size_t size_;
};

/// The same, from binary of either byte order.
class BinaryValues {
 public:
  BinaryValues(const std::filesystem::path& path, std::string_view bytes, const PlyHeader& header)
      : path_(path),
        bytes_(bytes),
        position_(header.data_begin),
        swap_(header.encoding == PlyEncoding::BigEndian) {}

  double next(PlyType type) {
    switch (type) {
      case PlyType::Int8:
        return read<std::int8_t>();
      case PlyType::Uint8:
        return read<std::uint8_t>();
      case PlyType::Int16:
        return read<std::int16_t>();
      case PlyType::Uint16:
        return read<std::uint16_t>();
      case PlyType::Int32:
        return read<std::int32_t>();
      case PlyType::Uint32:
        return read<std::uint32_t>();
      case PlyType::Float:
        return static_cast<double>(read<float>());
      case PlyType::Double:
        return read<double>();
    }
    return 0;
  }
  static std::size_t smallest(PlyType type) { return sizeOf(type); }
  std::size_t mayHold() const { return bytes_.size() - position_; }
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const {
    throw IoError(path_, "byte " + std::to_string(position_), expected, found);
  }

 private:
  template <class T>
  T read() {
    if (mayHold() < sizeof(T)) fail(std::to_string(sizeof(T)) + " bytes of a value", "the end of the file");
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  const std::filesystem::path& path_;
  std::string_view bytes_;
  std::size_t position_;
  bool swap_;
};

/// Refuses a count that the rest of the file cannot hold, before anything is allocated for it.
template <class Values>
void checkRoom(const Values& values, const PlyElement& element) {
  std::size_t smallest = 0;
  for (const PlyProperty& p : element.properties) smallest += Values::smallest(p.count_type.value_or(p.type));
  if (smallest == 0 || element.count <= values.mayHold() / smallest) return;
  values.fail(std::to_string(element.count) + " elements '" + element.name + "'",
              "room for " + std::to_string(values.mayHold() / smallest));
}

/// A number for a message.
inline std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

/// The length of the list that comes next; IoError when the rest of the file cannot hold it.
template <class Values>
std::size_t listLength(Values& values, const PlyProperty& property) {
  const double length = values.next(*property.count_type);
  const double room = static_cast<double>(values.mayHold() / Values::smallest(property.type));
  if (!(length >= 0 && length <= room)) values.fail("a list that fits the file", shown(length) + " values");
  return static_cast<std::size_t>(length);
}

/// Passes over one value or list.
template <class Values>
void skip(Values& values, const PlyProperty& property) {
  const std::size_t count = property.count_type ? listLength(values, property) : 1;
  for (std::size_t i = 0; i < count; ++i) values.next(property.type);
}

/// Passes over all rows of an element.
template <class Values>
void skipElement(Values& values, const PlyElement& element) {
  if (element.properties.empty()) return;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& p : element.properties) skip(values, p);
  }
}

}  // namespace vdbfuse::io
