// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace vdbfuse::tool {

/// What was wrong with the command line and, where a word was mistyped, which one is near: one sentence. An
/// unknown option counts before an argument that is missing, which it may have swallowed.
std::string describeUsageError(const CLI::App& app, const CLI::ParseError& error);

/// "vdbfuse fuse", or "vdbfuse" when no subcommand was recognised.
std::string commandOf(const CLI::App& app);

}  // namespace vdbfuse::tool
