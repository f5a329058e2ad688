// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cli/command_tree.h"
#include "cli/completion.h"
#include "cli/one_of.h"

namespace vdbfuse::tool {
namespace {

// Inside single quotes; brackets and colons mean something to _arguments.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

// ":LENGTH:action" as _arguments wants it.
std::string valueOf(const ArgumentInfo& a) {
  std::string action = " ";
  if (!a.choices.empty()) {
    action = a.value == "WORDS" ? "_values -s , word " + joined(a.choices, " ")
                                : "(" + joined(a.choices, " ") + ")";
  } else if (a.value == "FOLDER") {
    action = "_files -/";
  } else if (a.value == "FILE" || a.value == "PATH" || a.value == "DATASET:VIEW") {
    action = "_files";
  }
  return ":" + escaped(a.value.empty() ? a.name : a.value) + ":" + action;
}

std::string argumentsCall(const CommandInfo& command, const std::string& indent) {
  std::string text = indent + "_arguments";
  const std::string next = " \\\n" + indent + "  ";
  for (const ArgumentInfo& option : command.options)
    text += next + "'" + option.name + "[" + escaped(option.text) + "]" +
            (option.is_flag ? "" : valueOf(option)) + "'";
  int place = 0;
  for (const ArgumentInfo& argument : command.arguments)
    text += next + "'" + std::to_string(++place) + valueOf(argument) + "'";
  return text + "\n";
}

std::string described(const CommandInfo& command) {
  return "    '" + command.app->get_name() + ":" + escaped(command.summary) + "'\n";
}

}  // namespace

std::string zshCompletion(const CLI::App& app) {
  std::string names, cases;
  for (const CommandInfo& command : describeSubcommands(app)) {
    names += described(command);
    cases += "        " + command.app->get_name() + ")\n" + argumentsCall(command, "          ") +
             "          ;;\n";
  }
  return "#compdef vdbfuse\n# zsh completion for vdbfuse, made by: vdbfuse completion zsh\n\n_vdbfuse() {\n"
         "  local -a commands=(\n" +
         names +
         "  )\n  local state line\n  local curcontext=\"$curcontext\"\n"
         "  _arguments -C '--help[Print help]' '--version[Print the version]' '1:command:->command' "
         "'*::argument:->argument'\n"
         "  case $state in\n    command) _describe command commands ;;\n    argument)\n"
         "      case $line[1] in\n" +
         cases +
         "      esac ;;\n  esac\n}\n\n"
         "if [ \"$funcstack[1]\" = _vdbfuse ]; then _vdbfuse \"$@\"; else compdef _vdbfuse vdbfuse; fi\n";
}

}  // namespace vdbfuse::tool
