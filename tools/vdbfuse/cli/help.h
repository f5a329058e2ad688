// SPDX-License-Identifier: Apache-2.0
// --help: examples first, then what the command does, its arguments, and its options under their headings.
#pragma once

#include <CLI/App.hpp>
#include <memory>
#include <string>

namespace vdbfuse::tool {

/// The help of a subcommand or of the whole tool, at most 100 columns wide.
std::string helpOf(const CLI::App& command);

/// Makes the parser print helpOf().
std::shared_ptr<CLI::FormatterBase> helpFormatter();

}  // namespace vdbfuse::tool
