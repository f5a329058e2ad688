// SPDX-License-Identifier: Apache-2.0
#include "io/text_lines.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "io/file_bytes.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {

std::vector<TextLine> readTextLines(const std::filesystem::path& path, std::size_t most_bytes) {
  const std::uint64_t size = io::fileSize(path);
  if (size > most_bytes) {
    throw IoError(path, "", "a text file of at most " + std::to_string(most_bytes) + " bytes",
                  std::to_string(size) + " bytes");
  }
  std::istringstream text(io::readFileBytes(path));
  std::vector<TextLine> lines;
  std::string content;
  for (int number = 1; std::getline(text, content); ++number) {
    TextLine line{number, {}};
    std::istringstream words(content);
    for (std::string word; words >> word;) line.words.push_back(word);
    if (!line.words.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

std::vector<TextLine> readListing(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = 64 << 20;
  std::vector<TextLine> lines = readTextLines(path, kMostBytes);
  std::erase_if(lines, [](const TextLine& line) { return line.words.front().front() == '#'; });
  return lines;
}

std::string linePlace(std::span<const TextLine> lines, std::size_t index) {
  if (index < lines.size()) return "line " + std::to_string(lines[index].number);
  return "line " + std::to_string(lines.empty() ? 1 : lines.back().number + 1);
}

std::string numberText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

double finiteNumber(const std::filesystem::path& path, const TextLine& line, const std::string& word) {
  // from_chars refuses the leading plus that printf("%+e") writes.
  const char* begin = word.data() + (word.size() > 1 && word[0] == '+' ? 1 : 0);
  const char* end = word.data() + word.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value))
    throw IoError(path, "line " + std::to_string(line.number), "a finite number", "'" + word + "'");
  return value;
}

std::vector<double> finiteNumbers(const std::filesystem::path& path, const TextLine& line) {
  std::vector<double> numbers;
  for (const std::string& word : line.words) numbers.push_back(finiteNumber(path, line, word));
  return numbers;
}

Eigen::MatrixXd readMatrix(const std::filesystem::path& path, std::span<const TextLine> lines,
                           std::size_t first, int rows, int columns, const std::string& what) {
  Eigen::MatrixXd matrix(rows, columns);
  for (int row = 0; row < rows; ++row) {
    const std::size_t index = first + static_cast<std::size_t>(row);
    if (index >= lines.size()) throw IoError(path, linePlace(lines, index), what, "the end of the file");
    const std::vector<double> numbers = finiteNumbers(path, lines[index]);
    if (numbers.size() != static_cast<std::size_t>(columns))
      throw IoError(path, linePlace(lines, index), what,
                    std::to_string(numbers.size()) + " numbers in a row");
    matrix.row(row) = Eigen::Map<const Eigen::RowVectorXd>(numbers.data(), columns);
  }
  return matrix;
}

}  // namespace vdbfuse
