// SPDX-License-Identifier: Apache-2.0
// Every subcommand is one file with one function that declares its options and, when its subcommand is
// chosen, sets the action. What runs prints results to stdout and words to stderr, and throws vdbfuse::Error
// when it fails (exit code 1).
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "cli/resolved.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse::tool {

/// Set by the subcommand that was chosen; main() runs it after all options have been parsed.
struct Action {
  std::function<void()> run;
  std::vector<FoundValue> found;  ///< by the run, for options that were left open
  std::filesystem::path save_config;
  std::string simd;

  Action& operator=(std::function<void()> function) {
    run = std::move(function);
    return *this;
  }
};

/// Everything that the tool understands: options of all subcommands, and all subcommands. `action` must
/// outlive the parsing.
void declareCommandLine(CLI::App& app, Action& action);

/// What --save-config asks for, for a subcommand that writes it together with its results; from then on it
/// is nothing that main() would have to do. Empty without it.
std::vector<Output> takeConfig(const CLI::App& command, Action& action);

void addCompare(CLI::App& app, Action& action);
void addCompletion(CLI::App& app, Action& action);
void addConvert(CLI::App& app, Action& action);
void addEvaluate(CLI::App& app, Action& action);
void addFormats(CLI::App& app, Action& action);
void addFuse(CLI::App& app, Action& action);
void addInfo(CLI::App& app, Action& action);
void addJudge(CLI::App& app, Action& action);
void addManual(CLI::App& app, Action& action);
void addRender(CLI::App& app, Action& action);
void addStereo(CLI::App& app, Action& action);
void addSynth(CLI::App& app, Action& action);

}  // namespace vdbfuse::tool
