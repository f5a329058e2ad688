// SPDX-License-Identifier: Apache-2.0
#include "formats/pcd_columns.h"

#include <cstdint>
#include <cstring>

#include "io/text_cursor.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

namespace fs = std::filesystem;
using Columns = std::vector<std::vector<double>>;

template <class T>
double valueAt(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

using Reader = double (*)(const char*);

Reader readerOf(const PcdField& field) {
  const auto by_size = [&](Reader one, Reader two, Reader four, Reader eight) -> Reader {
    return field.size == 1   ? one
           : field.size == 2 ? two
           : field.size == 4 ? four
           : field.size == 8 ? eight
                             : nullptr;
  };
  if (field.type == "F") return by_size(nullptr, nullptr, valueAt<float>, valueAt<double>);
  if (field.type == "I")
    return by_size(valueAt<std::int8_t>, valueAt<std::int16_t>, valueAt<std::int32_t>, valueAt<std::int64_t>);
  return by_size(valueAt<std::uint8_t>, valueAt<std::uint16_t>, valueAt<std::uint32_t>,
                 valueAt<std::uint64_t>);
}

// Where a field lies in a point: its values before, and its bytes before.
struct Place {
  std::size_t value = 0, byte = 0;
  Reader read = nullptr;
};

Place placeOf(const fs::path& path, const PcdLayout& layout, const std::string& name) {
  Place place;
  for (const PcdField& field : layout.fields) {
    place.read = readerOf(field);
    if (field.name == name && field.count == 1 && place.read != nullptr) return place;
    if (field.name == name)
      throw IoError(path, "field " + name, "one number of 1, 2, 4 or 8 bytes",
                    "SIZE " + std::to_string(field.size) + ", TYPE " + field.type + ", COUNT " +
                        std::to_string(field.count));
    place.value += static_cast<std::size_t>(field.count);
    place.byte += static_cast<std::size_t>(field.size * field.count);
  }
  throw IoError(path, "", "the field " + name, "none of that name");
}

// Values of a point, and its bytes.
Place endOf(const PcdLayout& layout) {
  Place end;
  for (const PcdField& field : layout.fields) {
    end.value += static_cast<std::size_t>(field.count);
    end.byte += static_cast<std::size_t>(field.size * field.count);
  }
  return end;
}

void requireRoom(const fs::path& path, const PcdLayout& layout, std::size_t room) {
  if (static_cast<std::uint64_t>(layout.points) <= room) return;
  throw IoError(path, "", std::to_string(layout.points) + " points", "room for " + std::to_string(room));
}

Columns readBinary(const fs::path& path, std::string_view bytes, const PcdLayout& layout,
                   const std::vector<Place>& places) {
  const std::size_t stride = endOf(layout).byte;
  requireRoom(path, layout, (bytes.size() - layout.data_begin) / stride);
  const auto points = static_cast<std::size_t>(layout.points);
  Columns columns(places.size(), std::vector<double>(points));
  for (std::size_t i = 0; i < points; ++i) {
    const char* point = bytes.data() + layout.data_begin + i * stride;
    for (std::size_t c = 0; c < places.size(); ++c) columns[c][i] = places[c].read(point + places[c].byte);
  }
  return columns;
}

Columns readText(const fs::path& path, std::string_view bytes, const PcdLayout& layout,
                 const std::vector<Place>& places) {
  const std::size_t values = endOf(layout).value;
  // A digit and what separates it from the next; the very last value needs no separator.
  requireRoom(path, layout, (bytes.size() - layout.data_begin + 1) / (2 * values));
  const auto points = static_cast<std::size_t>(layout.points);
  Columns columns(places.size(), std::vector<double>(points));
  TextCursor cursor(path, bytes, layout.data_begin);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t v = 0; v < values; ++v) {
      const double value = cursor.number();
      for (std::size_t c = 0; c < places.size(); ++c) {
        if (places[c].value == v) columns[c][i] = value;
      }
    }
  }
  return columns;
}

}  // namespace

Columns readPcdColumns(const fs::path& path, std::string_view bytes, const PcdLayout& layout,
                       const std::vector<std::string>& names) {
  if (layout.data == "binary_compressed")
    throw IoError(path, "", "DATA ascii or binary (unorganised clouds)", "binary_compressed");
  std::vector<Place> places;
  for (const std::string& name : names) places.push_back(placeOf(path, layout, name));
  return layout.data == "ascii" ? readText(path, bytes, layout, places)
                                : readBinary(path, bytes, layout, places);
}

}  // namespace vdbfuse::io
