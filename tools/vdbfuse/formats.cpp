// SPDX-License-Identifier: Apache-2.0
// vdbfuse formats: what data sets look like.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/image_set.h"

namespace vdbfuse::tool {
namespace {

constexpr const char* kDepthTitle = "Depth maps";
constexpr const char* kImageTitle = "Photographs with cameras (vdbfuse stereo)";

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

void listOne(const auto& format, const char* remark) {
  std::printf("%s: %s%s\n\n%s\n", std::string(format.name).c_str(), std::string(format.description).c_str(),
              remark, indented(format.layout).c_str());
}

void list() {
  std::printf("%s\n\n", kDepthTitle);
  for (const DepthSetFormat& format : depthSetFormats())
    listOne(format, format.write == nullptr ? "" : " (also written by vdbfuse convert)");
  std::printf("%s\n\n", kImageTitle);
  for (const ImageSetFormat& format : imageSetFormats()) listOne(format, "");
}

const char* fitText(Detection::Fit fit) {
  return fit == Detection::Fit::Fully ? "yes" : fit == Detection::Fit::Partly ? "partly" : "no";
}

void explainAll(const auto& formats, const std::filesystem::path& path) {
  for (const auto& format : formats) {
    const Detection found = format.detect(path);
    std::printf("%-12s %-7s %s\n", std::string(format.name).c_str(), fitText(found.fit),
                found.reason.c_str());
  }
}

void explain(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path))
    throw IoError(path, "", "a data set of depth maps or photographs", "nothing of that name");
  std::printf("%s\n", kDepthTitle);
  explainAll(depthSetFormats(), path);
  std::printf("\n%s\n", kImageTitle);
  explainAll(imageSetFormats(), path);
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
