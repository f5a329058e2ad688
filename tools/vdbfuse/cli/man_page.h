// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace vdbfuse::tool {

/// The manual page of a subcommand, or of the whole tool, for man(7) macros. REQUIRES: `command` is `app` or
/// one of its subcommands.
std::string manPage(const CLI::App& app, const CLI::App& command);

/// "vdbfuse-fuse", "vdbfuse": the page's name.
std::string manPageName(const CLI::App& command);

}  // namespace vdbfuse::tool
