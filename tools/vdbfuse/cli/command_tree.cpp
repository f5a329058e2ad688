// SPDX-License-Identifier: Apache-2.0
#include "cli/command_tree.h"

#include <algorithm>
#include <sstream>

#include "cli/one_of.h"

namespace vdbfuse::tool {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

// The parser adds what its checks say of themselves behind a colon, which a kind may have in its own name.
std::string kindOf(const CLI::Option& option) {
  const std::string all = option.get_type_name();
  std::string kind = all.substr(0, all.find(':'));
  for (const ValueKind& known : valueKinds()) {
    const std::string name = known.name;
    if (name.size() > kind.size() && (all + ":").starts_with(name + ":")) kind = name;
  }
  return kind;
}

ArgumentInfo infoOf(const CLI::Option& option) {
  ArgumentInfo info;
  info.option = &option;
  info.by_place = option.get_positional();
  info.key = option.get_lnames().empty() ? option.get_name(true) : option.get_lnames().front();
  info.name = info.by_place ? option.get_name(true) : "--" + info.key;
  if (info.by_place) info.name = info.name.substr(0, info.name.find(','));
  info.is_flag = option.get_expected_min() == 0;
  if (!info.is_flag) info.value = kindOf(option);
  info.choices = choicesOf(option);
  info.text = option.get_description();
  info.fallback = option.get_option_text().empty() ? option.get_default_str() : option.get_option_text();
  info.required = option.get_required();
  info.group = option.get_group();
  return info;
}

// The options of one app, each heading's together.
void addOptions(const CLI::App& app, CommandInfo& command) {
  for (const std::string& group : app.get_groups()) {
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_group() != group || group.empty()) continue;
      ArgumentInfo info = infoOf(*option);
      (info.by_place ? command.arguments : command.options).push_back(std::move(info));
    }
  }
}

bool isHelp(const ArgumentInfo& info) { return info.key == "help" || info.key == "version"; }

}  // namespace

const std::vector<ValueKind>& valueKinds() {
  static const std::vector<ValueKind> kinds = {
      {"FILE", ""},
      {"FOLDER", ""},
      {"PATH", "a file or a folder"},
      {"LENGTH", "in the unit of the poses, metres for most scans"},
      {"1/LENGTH", "per unit of the poses"},
      {"DEGREES", ""},
      {"PIXELS", ""},
      {"VOXELS", "times the edge of the finest cells"},
      {"SHARE", "between 0 and 1"},
      {"LOG-ODDS", "natural logarithm of the odds"},
      {"GREY-LEVELS", "of 255"},
      {"NUMBER", "without a unit"},
      {"N", "a whole number"},
      {"SIZE", "bytes, as in 8GiB, 500MB"},
      {"WORD", "one of those listed"},
      {"WORDS", "some of those listed, with commas between them"},
      {"NAME", ""},
      {"WxH", "width and height in pixels, as in 640x480"},
      {"DATASET:VIEW", "a data set, and the name or number of one of its views"},
      {"x,y,z", "a point, in the unit of the poses"},
      {"x0,y0,z0,x1,y1,z1", "two corners of a box, the lower one first, in the unit of the poses"},
      {"fx,fy,cx,cy", "in pixels"},
      {"low,high", ""},
      {"x|y|z=VALUE", "a plane across an axis, in the unit of the poses"},
  };
  return kinds;
}

CommandInfo describe(const CLI::App& command) {
  CommandInfo info;
  info.app = &command;
  const CLI::App* parent = command.get_parent();
  info.name = (parent != nullptr ? parent->get_name() + " " : "") + command.get_name();
  const std::string text = command.get_description();
  const std::size_t end = text.find("\n\n");
  info.summary = text.substr(0, end);
  if (end != std::string::npos) info.details = text.substr(end + 2);
  info.examples = linesOf(command.get_footer());
  addOptions(command, info);
  if (parent != nullptr) addOptions(*parent, info);
  // What all subcommands have belongs to the end, and help there, once; the version to the tool itself.
  std::vector<ArgumentInfo>& options = info.options;
  const std::string common = (parent != nullptr ? *parent : command).get_help_ptr()->get_group();
  for (ArgumentInfo& option : options)
    if (isHelp(option)) option.group = common;
  std::stable_partition(options.begin(), options.end(),
                        [&](const ArgumentInfo& o) { return o.group != common; });
  const auto help =
      std::stable_partition(options.begin(), options.end(), [](const ArgumentInfo& o) { return !isHelp(o); });
  if (parent != nullptr && help != options.end()) options.erase(help + 1, options.end());
  return info;
}

std::vector<CommandInfo> describeSubcommands(const CLI::App& app) {
  std::vector<CommandInfo> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) commands.push_back(describe(*command));
  return commands;
}

std::string usageOf(const CommandInfo& command) {
  std::string usage;
  for (const ArgumentInfo& argument : command.arguments)
    usage += (usage.empty() ? "" : " ") + (argument.required ? argument.name : "[" + argument.name + "]");
  return usage + (usage.empty() ? "" : " ") + "[OPTIONS]";
}

std::string signatureOf(const ArgumentInfo& argument) {
  constexpr std::size_t kLongest = 30;
  if (argument.by_place || argument.is_flag) return argument.name;
  if (argument.choices.empty() || argument.value == "WORDS") return argument.name + " " + argument.value;
  const std::string words = joined(argument.choices, "|");
  return argument.name + " " + (words.size() <= kLongest ? words : argument.value);
}

std::vector<std::string> groupsOf(const CommandInfo& command) {
  std::vector<std::string> groups;
  for (const ArgumentInfo& option : command.options)
    if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) groups.push_back(option.group);
  return groups;
}

}  // namespace vdbfuse::tool
