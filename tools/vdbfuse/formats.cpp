// SPDX-License-Identifier: Apache-2.0
// vdbfuse formats: what data sets look like.
#include <cstdio>
#include <string>

#include "commands.h"
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

void run() {
  for (const DepthSetFormat& format : depthSetFormats()) {
    std::printf("%s: %s\n\n%s\n", std::string(format.name).c_str(), std::string(format.description).c_str(),
                indented(format.layout).c_str());
  }
}

}  // namespace

void addFormats(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand(
      "formats",
      "List the formats of data sets that can be read, each with an example of its layout.\n\n"
      "Example: vdbfuse formats");
  command->callback([&action] { action = run; });
}

}  // namespace vdbfuse::tool
