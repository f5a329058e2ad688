// SPDX-License-Identifier: Apache-2.0
// vdbfuse completion SHELL: a script for the shell.
#include "cli/completion.h"

#include <cstdio>
#include <memory>

#include "cli/one_of.h"
#include "commands.h"

namespace vdbfuse::tool {

void addCompletion(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand(
      "completion",
      "Print a script by which a shell completes vdbfuse\n\n"
      "The installed packages bring it. For a build that is not installed, put one of the examples into "
      "~/.bashrc or ~/.zshrc.");
  sub.footer(
      "eval \"$(vdbfuse completion bash)\"\n"
      "eval \"$(vdbfuse completion zsh)\"        # after compinit");
  const auto shell = std::make_shared<std::string>();
  sub.add_option("SHELL,--shell", *shell, "Which shell")
      ->required()
      ->transform(oneOf({"bash", "zsh"}))
      ->type_name("WORD");
  sub.callback([&app, &action, shell] {
    action = [&app, shell] {
      std::fputs((*shell == "bash" ? bashCompletion(app) : zshCompletion(app)).c_str(), stdout);
    };
  });
}

}  // namespace vdbfuse::tool
