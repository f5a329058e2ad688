// SPDX-License-Identifier: Apache-2.0
// What the command line looks like, read from the parser itself: help, completion, man pages, the saved
// configuration and --explain are all made from this and cannot disagree with what is accepted.
//
// How a subcommand fills it: the first paragraph of App::description() is the summary, the rest the details;
// each line of App::footer() is an example; an option's group is its heading; type_name() is one of
// valueKinds(); default_str() a default that could be given as it is; option_text() any other, in words.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace vdbfuse::tool {

/// What stands for a value, and what it means.
struct ValueKind {
  const char* name;     ///< "LENGTH"
  const char* meaning;  ///< "in the unit of the poses"; empty: the name says it
};
const std::vector<ValueKind>& valueKinds();

/// An argument by place, an option, or a flag.
struct ArgumentInfo {
  std::string name;      ///< "--voxel"; "OUT" for an argument by place
  std::string key;       ///< "voxel": its name in a configuration file
  std::string value;     ///< what stands for its value; empty: a flag
  std::string text;      ///< one or two sentences, without a full stop
  std::string fallback;  ///< default, as a value or in words; empty: none
  std::string group;
  std::vector<std::string> choices;  ///< the words that are allowed; empty: anything of the kind
  bool by_place = false, required = false, is_flag = false;
  const CLI::Option* option = nullptr;
};

struct CommandInfo {
  std::string name;     ///< "vdbfuse fuse"
  std::string summary;  ///< one sentence
  std::string details;  ///< paragraphs; may be empty
  std::vector<std::string> examples;
  std::vector<ArgumentInfo> arguments;  ///< by place, in order
  std::vector<ArgumentInfo> options;    ///< in the order of their groups, those of all subcommands last
  const CLI::App* app = nullptr;
};

CommandInfo describe(const CLI::App& command);

/// Of the subcommands that are not hidden, in order.
std::vector<CommandInfo> describeSubcommands(const CLI::App& app);

/// "INPUT OUT [OPTIONS]"
std::string usageOf(const CommandInfo& command);

/// "--voxel LENGTH", "--method tsdf|visibility"; of a long list of choices only the kind.
std::string signatureOf(const ArgumentInfo& argument);

/// The options under the headings, in order.
std::vector<std::string> groupsOf(const CommandInfo& command);

}  // namespace vdbfuse::tool
