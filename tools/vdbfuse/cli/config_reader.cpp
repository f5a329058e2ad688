// SPDX-License-Identifier: Apache-2.0
#include "cli/config_reader.h"

#include <toml++/toml.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "cli/command_tree.h"
#include "cli/nearest.h"
#include "cli/one_of.h"

namespace vdbfuse::tool {
namespace {

[[noreturn]] void fail(const std::string& place, const std::string& what) {
  throw CLI::ConfigError(place + ": " + what, CLI::ExitCodes::ConfigError);
}

std::string shortest(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

// As it would be typed. Nothing when it is a table or a date.
std::vector<std::string> wordsOf(const toml::node& node) {
  if (const toml::array* list = node.as_array()) {
    std::vector<std::string> words;
    for (const toml::node& element : *list)
      for (std::string& word : wordsOf(element)) words.push_back(std::move(word));
    return words;
  }
  if (const auto* text = node.as_string()) return {text->get()};
  if (const auto* whole = node.as_integer()) return {std::to_string(whole->get())};
  if (const auto* number = node.as_floating_point()) return {shortest(number->get())};
  if (const auto* flag = node.as_boolean()) return {flag->get() ? "true" : "false"};
  return {};
}

struct Entry {
  std::string place;
  const toml::node* value = nullptr;
};
using Entries = std::map<std::string, Entry>;

class Document {
 public:
  Document(toml::table table, std::string path) : table_(std::move(table)), path_(std::move(path)) {}

  // What counts for the subcommand: its section, and what stands before all sections.
  Entries entriesFor(const CLI::App& app, const CLI::App& command) const {
    std::vector<std::string> commands;
    for (const CommandInfo& info : describeSubcommands(app)) commands.push_back(info.app->get_name());
    Entries entries;
    const toml::table* section = nullptr;
    for (const auto& pair : table_) {
      const std::string name(pair.first.str());
      const toml::table* table = pair.second.as_table();
      if (table == nullptr) {
        if (name != "version") entries[name] = entryOf(pair.first, pair.second);
      } else if (name == command.get_name()) {
        section = table;
      } else if (std::find(commands.begin(), commands.end(), name) == commands.end()) {
        fail(placeOf(pair.first), "unknown section [" + name + "]" + didYouMean(name, commands));
      }
    }
    if (section == nullptr) return entries;
    for (const auto& pair : *section)
      entries[std::string(pair.first.str())] = entryOf(pair.first, pair.second);
    return entries;
  }

 private:
  std::string placeOf(const toml::key& key) const {
    return path_ + ", line " + std::to_string(key.source().begin.line);
  }
  Entry entryOf(const toml::key& key, const toml::node& value) const { return {placeOf(key), &value}; }

  toml::table table_;
  std::string path_;
};

toml::table parse(std::istream& input, const std::string& path) {
  try {
    return toml::parse(input, path);
  } catch (const toml::parse_error& error) {
    fail(path + ", line " + std::to_string(error.source().begin.line), std::string(error.description()));
  }
}

bool isSameValue(const std::string& a, const std::string& b) {
  double x = 0, y = 0;
  return a == b || (CLI::detail::lexical_cast(a, x) && CLI::detail::lexical_cast(b, y) && x == y);
}

// The default need not be given, and does not count as given: an option that means something only together
// with others may stand in the file as long as it is left as it is.
bool isDefault(const CLI::Option& option, const std::vector<std::string>& words) {
  return option.get_option_text().empty() && isSameValue(joined(words, ","), option.get_default_str());
}

// Gives the option its value, where that is not the one it has.
void give(CLI::Option& option, const Entry& entry) {
  const std::vector<std::string> words = wordsOf(*entry.value);
  const bool is_flag = option.get_expected_min() == 0;
  if (words.empty()) fail(entry.place, "expected a value of '" + option.get_lnames().front() + "'");
  if (is_flag && !entry.value->is_boolean())
    fail(entry.place,
         "expected true or false for '" + option.get_lnames().front() + "', found '" + words.front() + "'");
  if (is_flag ? words.front() == "false" : isDefault(option, words)) return;
  try {
    option.add_result(words);
    option.run_callback();
  } catch (const CLI::ParseError& error) {
    fail(entry.place, error.what());
  }
}

void refuseUnknown(const Entries& entries, const std::vector<std::string>& known) {
  for (const auto& entry : entries)
    if (std::find(known.begin(), known.end(), entry.first) == known.end())
      fail(entry.second.place, "unknown key '" + entry.first + "'" + didYouMean(entry.first, known));
}

std::vector<CLI::Option*> configurable(CLI::App& app, CLI::App& command) {
  std::vector<CLI::Option*> options;
  for (CLI::App* owner : {&command, &app})
    for (CLI::Option* option : owner->get_options())
      if (!option->get_lnames().empty() && !isOfTheRun(option->get_lnames().front()))
        options.push_back(option);
  return options;
}

bool excludesOneOf(const CLI::Option& option, const std::set<const CLI::Option*>& given) {
  const std::set<CLI::Option*> excluded = option.get_excludes();
  return std::any_of(excluded.begin(), excluded.end(),
                     [&](const CLI::Option* other) { return given.count(other) > 0; });
}

}  // namespace

bool isOfTheRun(const std::string& key) {
  static const std::set<std::string> keys = {"help", "version", "config", "save-config", "explain"};
  return keys.count(key) > 0;
}

std::vector<CLI::ConfigItem> ConfigReader::from_config(std::istream& input) const {
  const std::vector<CLI::App*> commands = app_.get_subcommands();
  if (commands.empty()) return {};
  const std::string path = app_.get_config_ptr()->as<std::string>();
  const Document document(parse(input, path), path);
  const Entries entries = document.entriesFor(app_, *commands.front());
  const std::vector<CLI::Option*> options = configurable(app_, *commands.front());
  std::vector<std::string> known;
  std::set<const CLI::Option*> given;
  for (const CLI::Option* option : options) {
    known.push_back(option->get_lnames().front());
    if (option->count() > 0) given.insert(option);
  }
  refuseUnknown(entries, known);
  for (CLI::Option* option : options) {
    const auto entry = entries.find(option->get_lnames().front());
    if (given.count(option) > 0) {
      option->run_callback();
    } else if (entry != entries.end() && !excludesOneOf(*option, given)) {
      give(*option, entry->second);
      places_[option] = entry->second.place;
    }
  }
  return {};
}

std::string ConfigReader::placeOf(const CLI::Option& option) const {
  const auto place = places_.find(&option);
  return place == places_.end() ? "" : place->second;
}

}  // namespace vdbfuse::tool
