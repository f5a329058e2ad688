// SPDX-License-Identifier: Apache-2.0
// vdbfuse manual [COMMAND]: manual pages.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command_tree.h"
#include "cli/man_page.h"
#include "cli/one_of.h"
#include "commands.h"
#include "text_file.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

struct ManualOptions {
  std::string command;
  fs::path folder;
};

void writeAll(const CLI::App& app, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder, "cannot be created: " + error.message());
  replaceText(folder / (manPageName(app) + ".1"), manPage(app, app));
  for (const CommandInfo& command : describeSubcommands(app))
    replaceText(folder / (manPageName(*command.app) + ".1"), manPage(app, *command.app));
}

void run(const CLI::App& app, const ManualOptions& options) {
  if (!options.folder.empty()) {
    writeAll(app, options.folder);
    return;
  }
  const CLI::App& command = options.command.empty() ? app : *app.get_subcommand(options.command);
  std::fputs(manPage(app, command).c_str(), stdout);
}

}  // namespace

void addManual(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand("manual", "Print the manual page of a command, for man");
  sub.footer("vdbfuse manual fuse | man -l -");
  const auto options = std::make_shared<ManualOptions>();
  std::vector<std::string> commands;
  for (const CommandInfo& command : describeSubcommands(app)) commands.push_back(command.app->get_name());
  sub.add_option("COMMAND,--command", options->command, "Whose page")
      ->transform(oneOf(commands))
      ->type_name("WORD")
      ->option_text("that of vdbfuse itself");
  sub.option_defaults()->group("Output");
  sub.add_option("--folder", options->folder,
                 "Write all pages into this folder instead, replacing older ones")
      ->type_name("FOLDER")
      ->option_text("none");
  sub.callback([&app, &action, options] { action = [&app, options] { run(app, *options); }; });
}

}  // namespace vdbfuse::tool
