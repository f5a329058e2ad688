// SPDX-License-Identifier: Apache-2.0
// PLY files as tables: chosen properties of chosen elements as columns of numbers.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ply_header.h"

namespace vdbfuse::io {

struct PlyColumn {
  std::vector<double> values;
  /// For lists: those of row i are values [ends[i - 1], ends[i]), the first row's from 0. Empty for single
  /// values, of which there is one a row.
  std::vector<std::size_t> ends;
};

/// The properties that are wanted of one element.
struct PlySelection {
  std::string element;
  std::vector<std::string> properties;
};

/// Of each selection, in its order, each property as a column. `bytes` is the whole file and `header` what
/// parsePlyHeader() says of it. Counts are checked against the file's size before anything is allocated.
/// Throws IoError: an element or a property is missing, a value is no number, or the file ends before them.
std::vector<std::vector<PlyColumn>> readPlyTable(const std::filesystem::path& path, std::string_view bytes,
                                                 const PlyHeader& header,
                                                 std::span<const PlySelection> selections);

}  // namespace vdbfuse::io
