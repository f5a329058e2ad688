// SPDX-License-Identifier: Apache-2.0
// The options of how a subcommand runs and tells what it did, the same for all.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>

#include "json_file.h"

namespace vdbfuse::tool {

struct RunArguments {
  std::filesystem::path json;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

/// Heading of the options of this file in the help.
inline constexpr const char* kRunGroup = "Run";

/// --threads, --overwrite and --quiet.
void addRunOptions(CLI::App& app, RunArguments& arguments);

/// --json FILE, where "-" is standard output in place of the words for people.
void addJsonOption(CLI::App& app, std::filesystem::path& json, const std::string& help);

/// Whether --json names a file.
bool isFile(const std::filesystem::path& json);

/// Whether words for people go to standard output.
bool speaks(const RunArguments& arguments);

/// Throws IoError when the file of --json is there and may not be replaced. Ask before the work.
void refuseExistingJson(const RunArguments& arguments);

/// Writes the object where --json says; nothing without it. Throws IoError.
void report(const RunArguments& arguments, const Json& json);

}  // namespace vdbfuse::tool
