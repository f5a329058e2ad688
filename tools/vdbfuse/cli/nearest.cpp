// SPDX-License-Identifier: Apache-2.0
#include "cli/nearest.h"

#include <algorithm>

namespace vdbfuse::tool {
namespace {

std::optional<std::string> onlyOneBeginningWith(const std::string& typed,
                                                const std::vector<std::string>& words) {
  constexpr std::size_t kLeast = 3;  // letters, without the dashes
  if (typed.size() - std::min(typed.find_first_not_of('-'), typed.size()) < kLeast) return std::nullopt;
  std::optional<std::string> found;
  for (const std::string& word : words) {
    if (!word.starts_with(typed)) continue;
    if (found) return std::nullopt;
    found = word;
  }
  return found;
}

}  // namespace

std::size_t editDistance(std::string_view a, std::string_view b) {
  // Rows of the table of distances between beginnings: two before, one before, and this one.
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t wrong = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + wrong});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, above), std::swap(above, row);
  }
  return above[b.size()];
}

std::optional<std::string> nearest(const std::string& typed, const std::vector<std::string>& words) {
  const std::size_t letters = typed.size() - std::min(typed.find_first_not_of('-'), typed.size());
  const std::size_t most = std::max<std::size_t>(1, letters / 3);
  std::optional<std::string> best;
  std::size_t best_distance = most + 1;
  for (const std::string& word : words) {
    const std::size_t distance = editDistance(typed, word);
    if (distance < best_distance) best = word, best_distance = distance;
  }
  return best ? best : onlyOneBeginningWith(typed, words);
}

std::string didYouMean(const std::string& typed, const std::vector<std::string>& words) {
  const std::optional<std::string> word = nearest(typed, words);
  return word ? "; did you mean '" + *word + "'?" : "";
}

}  // namespace vdbfuse::tool
