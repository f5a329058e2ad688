// SPDX-License-Identifier: Apache-2.0
#include "ply_header.h"

#include <algorithm>
#include <utility>

#include "text_cursor.h"

namespace vdbfuse::io {
namespace {

constexpr std::pair<std::string_view, PlyType> kTypes[] = {
    {"char", PlyType::Int8},     {"int8", PlyType::Int8},     {"uchar", PlyType::Uint8},
    {"uint8", PlyType::Uint8},   {"short", PlyType::Int16},   {"int16", PlyType::Int16},
    {"ushort", PlyType::Uint16}, {"uint16", PlyType::Uint16}, {"int", PlyType::Int32},
    {"int32", PlyType::Int32},   {"uint", PlyType::Uint32},   {"uint32", PlyType::Uint32},
    {"float", PlyType::Float},   {"float32", PlyType::Float}, {"double", PlyType::Double},
    {"float64", PlyType::Double}};

PlyType parseType(TextCursor& cursor, std::string_view word) {
  for (const auto& [name, type] : kTypes) {
    if (word == name) return type;
  }
  cursor.fail("a PLY type", word);
}

PlyEncoding parseEncoding(TextCursor& cursor) {
  const std::string_view word = cursor.wordOnLine();
  if (word == "ascii") return PlyEncoding::Ascii;
  if (word == "binary_little_endian") return PlyEncoding::LittleEndian;
  if (word == "binary_big_endian") return PlyEncoding::BigEndian;
  cursor.fail("ascii, binary_little_endian or binary_big_endian", word);
}

PlyElement parseElement(TextCursor& cursor) {
  PlyElement element{std::string(cursor.wordOnLine()), 0, {}};
  const std::string_view word = cursor.wordOnLine();
  const auto count = parseInteger(word);
  if (!count || *count < 0) cursor.fail("the number of elements", word);
  element.count = static_cast<std::uint64_t>(*count);
  return element;
}

PlyProperty parseProperty(TextCursor& cursor) {
  PlyProperty property{};
  std::string_view word = cursor.wordOnLine();
  if (word == "list") {
    word = cursor.wordOnLine();
    property.count_type = parseType(cursor, word);
    if (*property.count_type >= PlyType::Float) cursor.fail("an integer type for the length of a list", word);
    word = cursor.wordOnLine();
  }
  property.type = parseType(cursor, word);
  property.name = cursor.wordOnLine();
  if (property.name.empty()) cursor.fail("the name of a property", "");
  return property;
}

}  // namespace

std::size_t sizeOf(PlyType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

const PlyElement* findElement(const PlyHeader& header, std::string_view name) {
  const auto found = std::find_if(header.elements.begin(), header.elements.end(),
                                  [&](const PlyElement& element) { return element.name == name; });
  return found == header.elements.end() ? nullptr : &*found;
}

const PlyProperty* findProperty(const PlyElement& element, std::string_view name) {
  const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                  [&](const PlyProperty& property) { return property.name == name; });
  return found == element.properties.end() ? nullptr : &*found;
}

PlyHeader parsePlyHeader(const std::filesystem::path& path, std::string_view bytes) {
  PlyHeader header;
  TextCursor cursor(path, bytes);
  const std::string_view magic = cursor.wordOnLine();
  if (magic != "ply") cursor.fail("'ply'", magic);
  bool has_format = false;
  for (cursor.restOfLine();; cursor.restOfLine()) {
    const std::string_view keyword = cursor.wordOnLine();
    if (keyword == "end_header") break;
    if (keyword == "format") {
      header.encoding = parseEncoding(cursor);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(parseElement(cursor));
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("an element before its properties", keyword);
      header.elements.back().properties.push_back(parseProperty(cursor));
    } else if (keyword == "obj_info") {
      const std::string name(cursor.wordOnLine());
      header.info[name] = cursor.wordOnLine();
    } else if (keyword != "comment") {
      cursor.fail("a line of a PLY header", keyword);
    }
  }
  if (!has_format) cursor.fail("a format line before the end of the header", "end_header");
  cursor.restOfLine();
  header.data_begin = cursor.position();
  return header;
}

}  // namespace vdbfuse::io
