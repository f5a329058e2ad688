// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <utility>

#include "cli/config_reader.h"
#include "cli/help.h"
#include "cli/one_of.h"
#include "run_options.h"
#include "text_file.h"
#include "vdbfuse/base/simd.h"
#include "vdbfuse/base/version.h"

namespace vdbfuse::tool {

// One line a subcommand, in the order of the help.
void addCommands(CLI::App& app, Action& action) {
  addFuse(app, action);
  addInfo(app, action);
  addFormats(app, action);
  addConvert(app, action);
  addStereo(app, action);
  addJudge(app, action);
  addRender(app, action);
  addEvaluate(app, action);
  addCompare(app, action);
  addSynth(app, action);
  addCompletion(app, action);
  addManual(app, action);
}

std::vector<Output> takeConfig(const CLI::App& command, Action& action) {
  if (action.save_config.empty()) return {};
  const std::string text = savedConfig(command, action.found);
  const auto write = [text](const std::filesystem::path& path) { writeText(path, text); };
  return {{std::exchange(action.save_config, {}), write}};
}

void declareCommandLine(CLI::App& app, Action& action) {
  app.name("vdbfuse");
  app.description("Depth maps, or photographs, to watertight surfaces by probabilistic visibility");
  app.footer(
      "vdbfuse fuse scan/ mesh.ply\n"
      "vdbfuse info scan/\n"
      "vdbfuse synth figure scan/ --arc ring --views 72");
  app.formatter(helpFormatter());
  app.option_defaults()->group(kRunGroup);
  app.set_help_flag("--help,-h", "Print this help");
  app.get_help_ptr()->group(kRunGroup);
  app.set_version_flag("--version", "vdbfuse " VDBFUSE_VERSION, "Print the version")->group(kRunGroup);
  app.set_config("--config", "", "Take options from this TOML file; the command line wins")
      ->type_name("FILE")
      ->option_text("none")
      ->group(kRunGroup);
  app.config_formatter(std::make_shared<ConfigReader>(app));
  app.add_option("--save-config", action.save_config,
                 "Write all options of this run, to run it again by --config")
      ->type_name("FILE")
      ->option_text("none");
  app.add_option("--simd", action.simd, "Vector instructions; others give other last digits")
      ->transform(oneOf(builtSimdTargets()))
      ->type_name("WORD")
      ->option_text("the best that this processor has");
  app.require_subcommand(1);
  // Options of all subcommands may stand behind the subcommand's name.
  app.fallthrough();
  addCommands(app, action);
}

}  // namespace vdbfuse::tool
