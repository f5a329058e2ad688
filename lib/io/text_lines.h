// SPDX-License-Identifier: Apache-2.0
// Small text files of numbers: poses, intrinsics, camera files.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vdbfuse {

/// The words of one line that is not blank.
struct TextLine {
  int number = 0;  ///< from 1
  std::vector<std::string> words;
};

/// All lines that are not blank. Throws IoError when the file cannot be read or is larger than `most_bytes`.
std::vector<TextLine> readTextLines(const std::filesystem::path& path, std::size_t most_bytes = 1 << 20);

/// The same without lines that begin with #.
std::vector<TextLine> readListing(const std::filesystem::path& path);

/// "line N" of lines[index], or of the line after the last one.
std::string linePlace(std::span<const TextLine> lines, std::size_t index);

/// A number for a message: six digits at most, no trailing zeros.
std::string numberText(double value);

/// A word as a finite number. Throws IoError when it is none.
double finiteNumber(const std::filesystem::path& path, const TextLine& line, const std::string& word);

/// The line's words as numbers. Throws IoError when one is no finite number.
std::vector<double> finiteNumbers(const std::filesystem::path& path, const TextLine& line);

/// Rows [first, first + rows) of `lines` as a matrix. `what` names it in errors, e.g. "a 3x3 matrix of
/// intrinsics". Throws IoError when lines are missing, or hold more or fewer than `columns` numbers.
Eigen::MatrixXd readMatrix(const std::filesystem::path& path, std::span<const TextLine> lines,
                           std::size_t first, int rows, int columns, const std::string& what);

}  // namespace vdbfuse
