// SPDX-License-Identifier: Apache-2.0
// Parts of a page that compares things side by side, one column each, and the page around them: one HTML file
// that loads nothing, light or dark as the reader's system is. All texts are plain and are escaped here; what
// is called html is put in as it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vdbfuse {

enum class Better { Lower, Higher, Neither };

/// The same quantity of every column.
struct NumberRow {
  std::string name;
  std::string words;  ///< what it is, smaller beside the name
  Better better = Better::Neither;
  std::vector<std::optional<double>> values;  ///< one a column; none: does not apply
  std::vector<std::string> texts;             ///< the same with their units, as they are shown
};

struct NumberGroup {
  std::string title;
  std::vector<NumberRow> rows;
};

/// The cells of a row that are best, as far as the texts tell them apart: none where all are alike, or only
/// one column has a value.
std::vector<std::size_t> bestOf(const NumberRow& row);

/// A table, a column a name; an arrow says which way is better, the best of each row is marked.
std::string numberTable(const std::vector<std::string>& columns, const std::vector<NumberGroup>& groups);

struct PictureRow {
  std::string caption;
  /// Bytes of PNG files, one a column; empty: a place without a picture.
  std::vector<std::string> pngs;
  /// What the colours mean, as html: colorBar() or colorKey(); may be empty.
  std::string key_html;
};

/// Pictures in a grid, the same columns in every row.
std::string pictureGrid(const std::vector<std::string>& columns, const std::vector<PictureRow>& rows);

/// The ramp of sequentialColor() with words at its two ends.
std::string colorBar(const std::string& low, const std::string& high);

struct KeyColor {
  std::string color;  ///< as CSS writes it
  std::string words;
};
/// Spots of colour with words.
std::string colorKey(const std::vector<KeyColor>& colors);

struct Section {
  std::string id, title;  ///< the id is that of the link in the page's contents
  std::string words;      ///< a paragraph
  std::string html;
};

struct Page {
  std::string title;
  std::string words;  ///< a line below the title
  std::vector<Section> sections;
  std::string footer_html;
};

/// The whole file.
std::string formatPage(const Page& page);

}  // namespace vdbfuse
