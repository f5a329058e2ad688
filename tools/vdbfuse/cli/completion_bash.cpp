// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cli/command_tree.h"
#include "cli/completion.h"
#include "cli/one_of.h"

namespace vdbfuse::tool {
namespace {

// What is common to all commands: files and folders, and lists of words with commas between them.
constexpr const char* kHead = R"(# bash completion for vdbfuse, made by: vdbfuse completion bash

_vdbfuse_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -f -- "$cur")
}
_vdbfuse_folders() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -d -- "$cur")
}
_vdbfuse_words() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}
_vdbfuse_list() {
  local begin=
  [[ $cur == *,* ]] && begin=${cur%,*},
  mapfile -t COMPREPLY < <(compgen -W "$1" -P "$begin" -- "${cur##*,}")
  compopt -o nospace 2>/dev/null
}

_vdbfuse() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev= command= word i
  [ "$COMP_CWORD" -gt 0 ] && prev=${COMP_WORDS[COMP_CWORD - 1]}
  # --option=value comes as three words.
  if [ "$cur" = = ]; then cur=; elif [ "$prev" = = ]; then prev=${COMP_WORDS[COMP_CWORD - 2]}; fi
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    if [[ $word != -* ]]; then command=$word; break; fi
  done
)";

bool isAnyOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

// How the value of an argument is completed; nothing for numbers.
std::string actionFor(const ArgumentInfo& a) {
  if (!a.choices.empty())
    return (a.value == "WORDS" ? "_vdbfuse_list '" : "_vdbfuse_words '") + joined(a.choices, " ") + "'";
  if (a.value == "FOLDER") return "_vdbfuse_folders";
  return isAnyOf(a.value, {"FILE", "PATH", "DATASET:VIEW"}) ? "_vdbfuse_files" : ":";
}

std::string optionValues(const CommandInfo& command, const std::string& indent) {
  std::string text = indent + "case $prev in\n";
  for (const ArgumentInfo& option : command.options)
    if (!option.is_flag) text += indent + "  " + option.name + ") " + actionFor(option) + "; return ;;\n";
  return text + indent + "esac\n";
}

std::string optionNames(const CommandInfo& command) {
  std::string names;
  for (const ArgumentInfo& option : command.options) names += (names.empty() ? "" : " ") + option.name;
  return names;
}

// Files where any argument by place is one; the words of the first one that has some.
std::string placesAction(const CommandInfo& command) {
  for (const ArgumentInfo& argument : command.arguments)
    if (!argument.choices.empty()) return actionFor(argument);
  return command.arguments.empty() ? ":" : "_vdbfuse_files";
}

std::string caseOf(const CommandInfo& command) {
  const std::string indent = "      ";
  return "    " + command.app->get_name() + ")\n" + optionValues(command, indent) + indent +
         "if [[ $cur == -* ]]; then _vdbfuse_words '" + optionNames(command) + "'; else " +
         placesAction(command) + "; fi ;;\n";
}

}  // namespace

std::string bashCompletion(const CLI::App& app) {
  std::string names, cases;
  for (const CommandInfo& command : describeSubcommands(app)) {
    names += (names.empty() ? "" : " ") + command.app->get_name();
    cases += caseOf(command);
  }
  return std::string(kHead) +
         "  case $command in\n    '')\n      if [[ $cur == -* ]]; then _vdbfuse_words '" +
         optionNames(describe(app)) + "'; else _vdbfuse_words '" + names + "'; fi ;;\n" + cases +
         "  esac\n}\ncomplete -F _vdbfuse vdbfuse\n";
}

}  // namespace vdbfuse::tool
