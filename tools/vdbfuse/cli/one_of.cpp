// SPDX-License-Identifier: Apache-2.0
#include "cli/one_of.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/nearest.h"

namespace vdbfuse::tool {
namespace {

constexpr const char* kName = "one of";

}  // namespace

std::vector<std::string> split(const std::string& text, char between) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, between);) words.push_back(word);
  return words;
}

std::string joined(const std::vector<std::string>& words, const std::string& between) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : between) + word;
  return all;
}

CLI::Validator oneOf(const std::vector<std::string>& words) {
  const auto check = [words](std::string& text) {
    const auto same = [&](const std::string& word) {
      return CLI::detail::to_lower(word) == CLI::detail::to_lower(text);
    };
    const auto found = std::find_if(words.begin(), words.end(), same);
    if (found == words.end())
      return "'" + text + "' is none of " + joined(words, ", ") + didYouMean(text, words);
    text = *found;
    return std::string();
  };
  return CLI::Validator(check, joined(words, "|"), kName);
}

std::vector<std::string> choicesOf(const CLI::Option& option) {
  // The parser gives its checks to nobody as constants.
  auto& writable = const_cast<CLI::Option&>(option);
  for (int i = 0;; ++i) {
    try {
      const CLI::Validator& check = *writable.get_validator(i);
      if (check.get_name() == kName) return split(check.get_description(), '|');
    } catch (const CLI::OptionNotFound&) {
      return {};
    }
  }
}

}  // namespace vdbfuse::tool
