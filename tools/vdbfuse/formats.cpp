// SPDX-License-Identifier: Apache-2.0
// vdbfuse formats: what data sets look like.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse::tool {
namespace {

std::string indented(std::string_view lines) {
  std::string result;
  bool line_start = true;
  for (const char c : lines) {
    if (line_start) result += "    ";
    result += c;
    line_start = c == '\n';
  }
  return result;
}

void list() {
  for (const DepthSetFormat& format : depthSetFormats()) {
    std::printf("%s: %s%s\n\n%s\n", std::string(format.name).c_str(), std::string(format.description).c_str(),
                format.write == nullptr ? "" : " (also written by vdbfuse convert)",
                indented(format.layout).c_str());
  }
}

const char* fitText(Detection::Fit fit) {
  return fit == Detection::Fit::Fully ? "yes" : fit == Detection::Fit::Partly ? "partly" : "no";
}

void explain(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw IoError(path, "", "a data set of depth maps", "nothing of that name");
  for (const DepthSetFormat& format : depthSetFormats()) {
    const Detection found = format.detect(path);
    std::printf("%-12s %-7s %s\n", std::string(format.name).c_str(), fitText(found.fit),
                found.reason.c_str());
  }
}

}  // namespace

void addFormats(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("formats",
                                         "List the formats of data sets that can be read, each with an "
                                         "example of its layout; or say for a folder\n"
                                         "or file which of them it fits, and what the others miss.\n\n"
                                         "Example: vdbfuse formats\n         vdbfuse formats scan/");
  const auto path = std::make_shared<std::filesystem::path>();
  command->add_option("PATH", *path, "Data set to look at");
  command->callback([&action, path] { action = [path] { path->empty() ? list() : explain(*path); }; });
}

}  // namespace vdbfuse::tool
