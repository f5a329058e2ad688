// SPDX-License-Identifier: Apache-2.0
// What the options of a run come to: given, by default, or found in the data.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "cli/config_reader.h"

namespace vdbfuse::tool {

/// What a run found for an option that was left open, or overruled.
struct FoundValue {
  std::string key;  ///< name of the option, without dashes; other names are values beside the options
  std::string value;
  std::string why;
};

/// A table for people: parameter, value, why. Every option of the subcommand that was run, then what else was
/// found.
std::string explain(const CLI::App& command, const ConfigReader& config,
                    const std::vector<FoundValue>& found);

/// A configuration file (ConfigReader) that runs the subcommand again: what was given and the defaults as
/// values, with whole paths; what was found in the data as comments, because the same data give it again;
/// files written beside the result as comments, too.
std::string savedConfig(const CLI::App& command, const std::vector<FoundValue>& found);

}  // namespace vdbfuse::tool
