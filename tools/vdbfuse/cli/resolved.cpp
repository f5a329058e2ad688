// SPDX-License-Identifier: Apache-2.0
#include "cli/resolved.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>

#include "cli/command_tree.h"
#include "cli/one_of.h"
#include "vdbfuse/base/version.h"

namespace vdbfuse::tool {
namespace {

const FoundValue* findIn(const std::vector<FoundValue>& found, const std::string& key) {
  const auto place =
      std::find_if(found.begin(), found.end(), [&](const FoundValue& f) { return f.key == key; });
  return place == found.end() ? nullptr : &*place;
}

std::vector<ArgumentInfo> allOf(const CLI::App& command) {
  const CommandInfo info = describe(command);
  std::vector<ArgumentInfo> all = info.arguments;
  all.insert(all.end(), info.options.begin(), info.options.end());
  const auto of_the_run = [](const ArgumentInfo& a) { return isOfTheRun(a.key); };
  all.erase(std::remove_if(all.begin(), all.end(), of_the_run), all.end());
  return all;
}

bool isPath(const ArgumentInfo& a) {
  static const std::set<std::string> kinds = {"FILE", "FOLDER", "PATH", "DATASET:VIEW"};
  return kinds.count(a.value) > 0;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      static const char* digits = "0123456789abcdef";
      result += std::string("\\u00") + digits[c >> 4] + digits[c & 15];
    } else {
      result += c;
    }
  }
  return result + '"';
}

// A number in the way TOML wants it, to the last bit; nothing when the text is none.
std::optional<std::string> numberText(const std::string& text) {
  const char* end = text.data() + text.size();
  long long whole = 0;
  const auto integer = std::from_chars(text.data(), end, whole);
  if (integer.ec == std::errc() && integer.ptr == end) return std::to_string(whole);
  double value = 0;
  const auto real = std::from_chars(text.data(), end, value);
  if (real.ec != std::errc() || real.ptr != end) return std::nullopt;
  std::array<char, 32> shortest;
  std::string number(shortest.data(),
                     std::to_chars(shortest.data(), shortest.data() + shortest.size(), value).ptr);
  if (number.find_first_of(".ein") == std::string::npos) number += ".0";
  return number;
}

std::string tomlOf(const ArgumentInfo& a, const std::string& word) {
  if (isPath(a)) return quoted(std::filesystem::absolute(word).lexically_normal().string());
  return numberText(word).value_or(quoted(word));
}

std::string tomlOf(const ArgumentInfo& a, const std::vector<std::string>& words) {
  if (a.option->get_items_expected_max() == 1 && words.size() == 1) return tomlOf(a, words.front());
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + tomlOf(a, word);
  return "[" + list + "]";
}

bool hasLiteralDefault(const ArgumentInfo& a) {
  return !a.fallback.empty() && a.option->get_option_text().empty();
}

// "key = value", or nothing when there is no value that could be given.
std::optional<std::string> assignment(const ArgumentInfo& a) {
  if (a.is_flag) return a.key + (a.option->count() > 0 ? " = true" : " = false");
  if (a.option->count() > 0) return a.key + " = " + tomlOf(a, a.option->results());
  if (!hasLiteralDefault(a)) return std::nullopt;
  if (a.value == "WORDS") return a.key + " = " + tomlOf(a, split(a.fallback, ','));
  return a.key + " = " + tomlOf(a, std::vector<std::string>{a.fallback});
}

std::string savedLine(const ArgumentInfo& a, const FoundValue* found) {
  const std::string note = found == nullptr ? "" : found->value + ", " + found->why;
  const std::optional<std::string> line = assignment(a);
  const bool is_found = found != nullptr && a.option->count() == 0;
  // "auto" may stand for what was found; any other default was overruled.
  if (!line || (is_found && a.fallback != "auto"))
    return "# " + a.key + ": " + (note.empty() ? a.fallback : note) + "\n";
  const bool is_written_beside = a.group == "Output" && isPath(a) && !a.by_place;
  return (is_written_beside ? "# " : "") + *line + (is_found ? "  # " + note : "") + "\n";
}

std::string valueText(const ArgumentInfo& a) {
  if (a.is_flag) return a.option->count() > 0 ? "yes" : "no";
  if (a.option->count() > 0) return joined(a.option->results(), ",");
  return hasLiteralDefault(a) ? a.fallback : "-";
}

std::string whyText(const ArgumentInfo& a, const ConfigReader& config) {
  const std::string place = config.placeOf(*a.option);
  if (!place.empty()) return place;
  if (a.option->count() > 0) return "command line";
  if (a.fallback.empty() && !a.is_flag) return "not given";
  return hasLiteralDefault(a) || a.is_flag ? "default" : "default: " + a.fallback;
}

std::string row(const std::string& name, const std::string& value, const std::string& why) {
  constexpr std::size_t kName = 18, kValue = 24;
  std::string line = name;
  line.resize(std::max(kName, line.size() + 1), ' ');
  line += value;
  line.resize(std::max(kName + kValue, line.size() + 1), ' ');
  return line + why + "\n";
}

}  // namespace

std::string explain(const CLI::App& command, const ConfigReader& config,
                    const std::vector<FoundValue>& found) {
  std::string text = row("parameter", "value", "why");
  std::set<std::string> told;
  for (const ArgumentInfo& a : allOf(command)) {
    const FoundValue* f = a.option->count() > 0 ? nullptr : findIn(found, a.key);
    text += f != nullptr ? row(a.key, f->value, f->why) : row(a.key, valueText(a), whyText(a, config));
    told.insert(a.key);
  }
  for (const FoundValue& f : found)
    if (told.count(f.key) == 0) text += row(f.key, f.value, f.why);
  return text;
}

std::string savedConfig(const CLI::App& command, const std::vector<FoundValue>& found) {
  const std::string name = describe(command).name;
  std::string text =
      "# " + name +
      " --config FILE runs this again. What the data decide are comments: the same data decide "
      "the same.\nversion = \"" VDBFUSE_VERSION "\"\n\n[" +
      command.get_name() + "]\n";
  static const std::set<std::string> no_setting = {"json", "overwrite", "quiet"};
  std::string group;
  for (const ArgumentInfo& a : allOf(command)) {
    if (no_setting.count(a.key) > 0) continue;
    if (!a.by_place && a.group != group) text += "\n# " + (group = a.group) + "\n";
    text += savedLine(a, findIn(found, a.key));
  }
  return text;
}

}  // namespace vdbfuse::tool
