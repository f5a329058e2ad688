// SPDX-License-Identifier: Apache-2.0
// Options whose value is a word of a list; a mistyped one is told which word is near.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>
#include <vector>

namespace vdbfuse::tool {

/// Accepts these words, whatever their case, and hands on the word as it is listed.
CLI::Validator oneOf(const std::vector<std::string>& words);

/// The words of oneOf() among the option's checks; none: anything goes.
std::vector<std::string> choicesOf(const CLI::Option& option);

std::vector<std::string> split(const std::string& text, char between);
std::string joined(const std::vector<std::string>& words, const std::string& between);

/// Adds an option that sets `target` to the value of one of the names. Its default is what `target` holds.
template <class T>
CLI::Option* addChoice(CLI::App& app, const std::string& name, T& target,
                       const std::map<std::string, T>& names, const std::string& help) {
  std::vector<std::string> words;
  std::string now;
  for (const auto& [word, value] : names) {
    words.push_back(word);
    if (value == target) now = word;
  }
  return app
      .add_option_function<std::string>(
          name, [&target, names](const std::string& word) { target = names.at(word); }, help)
      ->transform(oneOf(words))
      ->type_name("WORD")
      ->default_str(now);
}

}  // namespace vdbfuse::tool
