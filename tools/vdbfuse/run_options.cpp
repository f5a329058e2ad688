// SPDX-License-Identifier: Apache-2.0
#include "run_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/number_check.h"
#include "text_file.h"

namespace vdbfuse::tool {
namespace {

constexpr const char* kStandardOutput = "-";

}  // namespace

void addRunOptions(CLI::App& app, RunArguments& arguments) {
  app.add_option("--threads", arguments.threads, "Threads that compute; 0: all processors")
      ->check(nonNegativeNumber())
      ->type_name("N")
      ->capture_default_str()
      ->group(kRunGroup);
  app.add_flag("--overwrite", arguments.overwrite, "Replace outputs that exist")->group(kRunGroup);
  app.add_flag("--quiet", arguments.quiet, "Print errors only")->group(kRunGroup);
}

void addJsonOption(CLI::App& app, std::filesystem::path& json, const std::string& help) {
  app.add_option("--json", json, help + "; -: to standard output, in place of the words")
      ->type_name("FILE")
      ->option_text("none")
      ->group(kRunGroup);
}

bool isFile(const std::filesystem::path& json) { return !json.empty() && json != kStandardOutput; }

bool speaks(const RunArguments& arguments) { return !arguments.quiet && arguments.json != kStandardOutput; }

void refuseExistingJson(const RunArguments& arguments) {
  if (isFile(arguments.json) && !arguments.overwrite) refuseExisting(arguments.json);
}

JsonReport::JsonReport(const RunArguments& arguments, const Json& json) {
  if (arguments.json.empty()) return;
  text_ = jsonText(json) + "\n";
  if (!isFile(arguments.json)) return;
  file_.emplace(arguments.json);
  writeText(file_->temporaryPath(), text_, arguments.json);
}

void JsonReport::commit() {
  if (file_) {
    file_->commit();
  } else {
    std::fputs(text_.c_str(), stdout);
  }
}

}  // namespace vdbfuse::tool
