// SPDX-License-Identifier: Apache-2.0
// The options of how a subcommand runs and tells what it did, the same for all.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "json_file.h"
#include "vdbfuse/io/atomic_file.h"

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

/// What --json asks for; nothing without it. Written beside its place when it is made, before the result is
/// put in its own, so that a full disk leaves neither. Throws IoError.
class JsonReport {
 public:
  JsonReport(const RunArguments& arguments, const Json& json);
  /// Puts the file in its place, or prints.
  void commit();

 private:
  std::string text_;
  std::optional<AtomicFile> file_;
};

}  // namespace vdbfuse::tool
