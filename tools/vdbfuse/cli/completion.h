// SPDX-License-Identifier: Apache-2.0
// Scripts by which shells complete commands, options, words that an option takes, files and folders.
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace vdbfuse::tool {

/// For bash 4 and later; needs no other package.
std::string bashCompletion(const CLI::App& app);

/// For zsh: a file _vdbfuse for a folder of $fpath.
std::string zshCompletion(const CLI::App& app);

}  // namespace vdbfuse::tool
