// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace vdbfuse::io {

/// Rows of numbers from text, one after the other: the first `columns` of each line. Blanks, commas and
/// semicolons separate; lines that begin with # or //, names of columns in the first line and a lone number
/// in it are passed over. Throws IoError: a line is short or holds what is no number.
std::vector<double> readXyzText(const std::filesystem::path& path, std::size_t columns);

/// Numbers in the first line that holds at least three; 0 when there is none in `start`, the beginning of a
/// file.
std::size_t xyzColumns(const std::filesystem::path& path, std::string_view start);

}  // namespace vdbfuse::io
