// SPDX-License-Identifier: Apache-2.0
#include "ply_table.h"

#include <algorithm>

#include "ply_values.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

using Columns = std::vector<PlyColumn>;

// For each property of the element its place in the selection, or the size of the selection. Of several
// properties of one name the first counts.
std::vector<std::size_t> slotsOf(const PlyElement& element, const PlySelection& selection) {
  std::vector<std::size_t> slots;
  for (const PlyProperty& p : element.properties) {
    const auto found = std::find(selection.properties.begin(), selection.properties.end(), p.name);
    const bool is_first = findProperty(element, p.name) == &p;
    slots.push_back(is_first ? static_cast<std::size_t>(found - selection.properties.begin())
                             : selection.properties.size());
  }
  return slots;
}

template <class Values>
void readValue(Values& values, const PlyProperty& property, PlyColumn& column) {
  const std::size_t count = property.count_type ? listLength(values, property) : 1;
  for (std::size_t i = 0; i < count; ++i) column.values.push_back(values.next(property.type));
  if (property.count_type) column.ends.push_back(column.values.size());
}

template <class Values>
Columns readColumns(Values& values, const PlyElement& element, const PlySelection& selection) {
  const std::vector<std::size_t> slots = slotsOf(element, selection);
  Columns columns(selection.properties.size());
  for (std::uint64_t row = 0; row < element.count; ++row) {
    for (std::size_t p = 0; p < slots.size(); ++p) {
      if (slots[p] < columns.size())
        readValue(values, element.properties[p], columns[slots[p]]);
      else
        skip(values, element.properties[p]);
    }
  }
  return columns;
}

template <class Values>
std::vector<Columns> readElements(Values values, const PlyHeader& header,
                                  std::span<const PlySelection> selections) {
  std::vector<Columns> result(selections.size());
  std::size_t left = selections.size();
  for (const PlyElement& element : header.elements) {
    if (left == 0) break;
    checkRoom(values, element);
    const auto selection = std::find_if(
        selections.begin(), selections.end(),
        [&](const PlySelection& wanted) { return findElement(header, wanted.element) == &element; });
    if (selection == selections.end()) {
      skipElement(values, element);
      continue;
    }
    result[static_cast<std::size_t>(selection - selections.begin())] =
        readColumns(values, element, *selection);
    --left;
  }
  return result;
}

void requireAll(const std::filesystem::path& path, const PlyHeader& header,
                std::span<const PlySelection> selections) {
  for (const PlySelection& selection : selections) {
    const PlyElement* element = findElement(header, selection.element);
    if (element == nullptr)
      throw IoError(path, "", "the element '" + selection.element + "'", "none of that name");
    for (const std::string& name : selection.properties) {
      if (findProperty(*element, name) == nullptr)
        throw IoError(path, "", "the property '" + name + "' of the element '" + selection.element + "'",
                      "none of that name");
    }
  }
}

}  // namespace

std::vector<Columns> readPlyTable(const std::filesystem::path& path, std::string_view bytes,
                                  const PlyHeader& header, std::span<const PlySelection> selections) {
  requireAll(path, header, selections);
  if (header.encoding == PlyEncoding::Ascii)
    return readElements(TextValues(path, bytes, header), header, selections);
  return readElements(BinaryValues(path, bytes, header), header, selections);
}

}  // namespace vdbfuse::io
