// SPDX-License-Identifier: Apache-2.0
// Every subcommand is one file with one function that declares its options and, when its subcommand is
// chosen, sets the action. What runs prints results to stdout and words to stderr, and throws vdbfuse::Error
// when it fails (exit code 1).
#pragma once

#include <CLI/App.hpp>
#include <functional>

namespace vdbfuse::tool {

/// Set by the subcommand that was chosen; main() runs it after all options have been parsed.
using Action = std::function<void()>;

void addFormats(CLI::App& app, Action& action);
void addConvert(CLI::App& app, Action& action);
void addInfo(CLI::App& app, Action& action);
void addFuse(CLI::App& app, Action& action);
void addJudge(CLI::App& app, Action& action);
void addRender(CLI::App& app, Action& action);
void addStereo(CLI::App& app, Action& action);
void addSynth(CLI::App& app, Action& action);
void addEvaluate(CLI::App& app, Action& action);
void addCompare(CLI::App& app, Action& action);

}  // namespace vdbfuse::tool
