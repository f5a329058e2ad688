// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>

#include "cli/usage_error.h"
#include "commands.h"
#include "interrupts.h"
#include "json_file.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/simd.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse::tool {
namespace {

// Exit codes of the tool, whatever the parser library returns; 128 and the signal when interrupted.
constexpr int kDone = 0, kFailed = 1, kWrongUsage = 2, kSignal = 128;

bool hasFlag(const CLI::App& command, const char* name) {
  const CLI::Option* option = command.get_option_no_throw(name);
  return option != nullptr && option->count() > 0;
}

void perform(const CLI::App& app, Action& action) {
  const CLI::App& command = *app.get_subcommands().front();
  if (!action.save_config.empty() && !hasFlag(command, "--overwrite")) refuseExisting(action.save_config);
  if (!action.simd.empty()) useSimdTarget(action.simd);
  action.run();
  const auto& config = dynamic_cast<const ConfigReader&>(*app.get_config_formatter());
  if (hasFlag(command, "--explain")) std::printf("%s", explain(command, config, action.found).c_str());
  writeTogether(takeConfig(command, action));
  // A result that did not get through to a full disk is none.
  if (std::fflush(stdout) != 0) throw Error("standard output cannot be written");
}

int run(const CLI::App& app, Action& action) {
  const Interrupts interrupts;
  try {
    perform(app, action);
    return kDone;
  } catch (const Cancelled&) {
    std::fprintf(stderr, "vdbfuse: interrupted\n");
    return kSignal + interruptSignal();
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "vdbfuse: out of memory; try a larger --voxel\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vdbfuse: %s\n", error.what());
  }
  return kFailed;
}

int usageError(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
  const std::string command = commandOf(app);
  std::fprintf(stderr, "%s: %s\nSee %s --help\n", command.c_str(), describeUsageError(app, error).c_str(),
               command.c_str());
  return kWrongUsage;
}

int runCommandLine(int argc, char** argv) {
  CLI::App app;
  Action action;
  declareCommandLine(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return usageError(app, error);
  }
  return run(app, action);
}

}  // namespace
}  // namespace vdbfuse::tool

int main(int argc, char** argv) {
  // Images go back to the system when they are freed. By default the C library would keep their memory for
  // smaller things, a fifth of the peak.
  mallopt(M_MMAP_THRESHOLD, 1 << 20);
  return vdbfuse::tool::runCommandLine(argc, argv);
}
