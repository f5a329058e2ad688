// SPDX-License-Identifier: Apache-2.0
// --config FILE: options of a run from a TOML file.
//
//   [fuse]                 # options of vdbfuse fuse; several subcommands may have their sections
//   input = "scan"         # arguments by place have names, too
//   voxel = 0.002
//   bbox = [0, 0, 0, 1, 1, 1]
//   carve = true           # a flag
//
// A key whose value is the option's default counts as not given. What stands before the first section counts
// for the subcommand that is run. The command line wins over the file. A key that the subcommand does not
// know is an error.
#pragma once

#include <CLI/App.hpp>
#include <map>
#include <string>
#include <vector>

namespace vdbfuse::tool {

class ConfigReader : public CLI::Config {
 public:
  explicit ConfigReader(CLI::App& app) : app_(app) {}

  /// Hands the file's values to the options that the command line does not name, in the order in which the
  /// options were declared. Throws CLI::ConfigError with file, line and the nearest key; returns nothing that
  /// would be left for the parser to do.
  std::vector<CLI::ConfigItem> from_config(std::istream& input) const override;
  std::string to_config(const CLI::App*, bool, bool, std::string) const override { return {}; }

  /// "run.toml, line 7" when the option's value came from there, else empty.
  std::string placeOf(const CLI::Option& option) const;

 private:
  CLI::App& app_;
  mutable std::map<const CLI::Option*, std::string> places_;
};

/// Options that speak of a run and not of its result: they are in no configuration file.
bool isOfTheRun(const std::string& key);

}  // namespace vdbfuse::tool
