// SPDX-License-Identifier: Apache-2.0
#include "cli/help.h"

#include <algorithm>

#include "cli/command_tree.h"
#include "cli/one_of.h"
#include "cli/wrap.h"

namespace vdbfuse::tool {
namespace {

constexpr std::size_t kColumn = 30, kWidth = 100;

std::string entry(const std::string& left, const std::string& right) {
  std::string text = "  " + left;
  const bool is_long = text.size() + 2 > kColumn;
  if (!is_long) text.resize(kColumn, ' ');
  const std::string wrapped = wrap(right, kWidth - kColumn, kColumn);
  return text + (is_long ? "\n" + std::string(kColumn, ' ') : "") + wrapped + "\n";
}

std::string describe(const ArgumentInfo& a) {
  std::string text = a.text;
  const bool shows_choices = signatureOf(a).find('|') != std::string::npos;
  if (!a.choices.empty() && !shows_choices) text += ": " + joined(a.choices, ", ");
  if (a.required && !a.by_place) text += " [required]";
  if (!a.fallback.empty()) text += " [default: " + a.fallback + "]";
  return text;
}

std::string examplesOf(const CommandInfo& command) {
  std::string text;
  for (const std::string& example : command.examples)
    text += (text.empty() ? "Example: " : "         ") + example + "\n";
  return text;
}

// The kinds of values that occur and do not explain themselves.
std::string kindsOf(const CommandInfo& command) {
  std::string text;
  for (const ValueKind& kind : valueKinds()) {
    const bool occurs = std::any_of(
        command.options.begin(), command.options.end(),
        [&](const ArgumentInfo& option) { return signatureOf(option) == option.name + " " + kind.name; });
    if (occurs && *kind.meaning != '\0') text += entry(kind.name, kind.meaning);
  }
  return text.empty() ? text : "\nValues:\n" + text;
}

std::string argumentsOf(const CommandInfo& command) {
  std::string text;
  for (const ArgumentInfo& argument : command.arguments) text += entry(argument.name, describe(argument));
  return text.empty() ? text : "\nArguments:\n" + text;
}

std::string optionsOf(const CommandInfo& command) {
  std::string text;
  for (const std::string& group : groupsOf(command)) {
    text += "\n" + group + ":\n";
    for (const ArgumentInfo& option : command.options)
      if (option.group == group) text += entry(signatureOf(option), describe(option));
  }
  return text;
}

std::string subcommandsOf(const CLI::App& app) {
  std::string text = "\nCommands:\n";
  for (const CommandInfo& command : describeSubcommands(app))
    text += entry(command.app->get_name(), command.summary);
  return text + "\nvdbfuse COMMAND --help says more about each; so does man vdbfuse-COMMAND.\n";
}

class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string, CLI::AppFormatMode) const override {
    return helpOf(*app);
  }
};

}  // namespace

std::string helpOf(const CLI::App& app) {
  const CommandInfo command = describe(app);
  const bool is_tool = app.get_parent() == nullptr;
  std::string text = examplesOf(command) + "\n" + wrap(command.summary + ".", kWidth, 0) + "\n";
  if (!command.details.empty()) text += "\n" + wrap(command.details, kWidth, 0) + "\n";
  text += "\nUsage: " + command.name + " " + (is_tool ? "COMMAND ..." : usageOf(command)) + "\n";
  return text + argumentsOf(command) + (is_tool ? subcommandsOf(app) : "") + optionsOf(command) +
         kindsOf(command);
}

std::shared_ptr<CLI::FormatterBase> helpFormatter() { return std::make_shared<HelpFormatter>(); }

}  // namespace vdbfuse::tool
