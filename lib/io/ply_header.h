// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vdbfuse::io {

enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };
enum class PlyEncoding { Ascii, LittleEndian, BigEndian };

/// Bytes of one value in a binary file.
std::size_t sizeOf(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type;                       ///< of the value, or of the values of a list
  std::optional<PlyType> count_type;  ///< of the length of a list; none for a single value
};

struct PlyElement {
  std::string name;
  std::uint64_t count;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::Ascii;
  std::vector<PlyElement> elements;
  std::map<std::string, std::string> info;  ///< what `obj_info NAME VALUE` lines say; the last of a name
  std::size_t data_begin = 0;               ///< byte after the header
};

/// The element or property of that name; null where there is none.
const PlyElement* findElement(const PlyHeader& header, std::string_view name);
const PlyProperty* findProperty(const PlyElement& element, std::string_view name);

/// Reads the header only; `count`s are what the file says and checked by nobody yet. Throws IoError with the
/// line.
PlyHeader parsePlyHeader(const std::filesystem::path& path, std::string_view bytes);

}  // namespace vdbfuse::io
