// SPDX-License-Identifier: Apache-2.0
#include "cli/usage_error.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "cli/command_tree.h"
#include "cli/nearest.h"
#include "cli/one_of.h"

namespace vdbfuse::tool {
namespace {

const CLI::App& chosen(const CLI::App& app) {
  const std::vector<CLI::App*> commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CommandInfo& command : describeSubcommands(app)) names.push_back(command.app->get_name());
  return names;
}

std::vector<std::string> optionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const ArgumentInfo& option : describe(command).options) names.push_back("--" + option.key);
  return names;
}

std::optional<std::string> unknownOption(const std::vector<std::string>& left) {
  const auto found = std::find_if(left.begin(), left.end(), [](const std::string& word) {
    return word.size() > 1 && word[0] == '-' && (word[1] < '0' || word[1] > '9') && word[1] != '.';
  });
  if (found == left.end()) return std::nullopt;
  return found->substr(0, found->find('='));
}

std::string missingArguments(const CLI::App& command, const std::string& otherwise) {
  std::vector<std::string> missing;
  const CommandInfo info = describe(command);
  for (const auto* list : {&info.arguments, &info.options})
    for (const ArgumentInfo& argument : *list)
      if (argument.required && argument.option->count() == 0) missing.push_back(argument.name);
  if (missing.empty()) return otherwise;
  return joined(missing, " and ") + (missing.size() == 1 ? " is missing" : " are missing");
}

// "--voxel: ..." of the parser's message.
std::string describeMismatch(const CLI::App& command, const std::string& message) {
  const std::string name = message.substr(0, message.find(':'));
  for (const ArgumentInfo& option : describe(command).options) {
    if ("--" + option.key != name) continue;
    const int count = option.option->get_items_expected_min();
    return name + " needs " + (count == 1 ? "a value" : std::to_string(count) + " values") + ": " +
           signatureOf(option);
  }
  return message;
}

std::string describeExtra(const CLI::App& app, const std::string& extra) {
  if (&chosen(app) != &app) return "'" + extra + "' is one argument too many";
  return "unknown command '" + extra + "'" + didYouMean(extra, commandNames(app));
}

}  // namespace

std::string commandOf(const CLI::App& app) {
  const CLI::App& command = chosen(app);
  return &command == &app ? app.get_name() : app.get_name() + " " + command.get_name();
}

std::string describeUsageError(const CLI::App& app, const CLI::ParseError& error) {
  const bool is_extra = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  const bool is_short = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr;
  if (is_short) return describeMismatch(chosen(app), error.what());
  if (!is_extra && !is_missing) return error.what();
  const std::vector<std::string> left = app.remaining(true);
  const CLI::App& command = chosen(app);
  const bool has_command = &command != &app;
  if (!has_command && !left.empty() && left.front()[0] != '-') return describeExtra(app, left.front());
  if (const std::optional<std::string> option = unknownOption(left))
    return "unknown option '" + *option + "'" + didYouMean(*option, optionNames(command));
  if (is_extra && !left.empty()) return describeExtra(app, left.front());
  if (!has_command) return "a command is missing: one of " + joined(commandNames(app), ", ");
  return missingArguments(command, error.what());
}

}  // namespace vdbfuse::tool
