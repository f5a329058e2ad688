// SPDX-License-Identifier: Apache-2.0
// vdbfuse formats: what data sets look like.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "run_options.h"
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
  std::printf("%s\n", kDepthTitle);
  explainAll(depthSetFormats(), path);
  std::printf("\n%s\n", kImageTitle);
  explainAll(imageSetFormats(), path);
}

struct FormatsOptions : RunArguments {
  std::filesystem::path path;
};

// Of each format its name, its layout and, where there is something to look at, how far it fits.
Json jsonOf(const auto& formats, const std::filesystem::path& path) {
  Json list = Json::array();
  for (const auto& format : formats) {
    Json one = {{"name", format.name}, {"description", format.description}, {"layout", format.layout}};
    if (!path.empty()) {
      const Detection found = format.detect(path);
      one["fits"] = fitText(found.fit), one["reason"] = found.reason;
    }
    list.push_back(std::move(one));
  }
  return list;
}

void run(const FormatsOptions& options) {
  refuseExistingJson(options);
  const auto& path = options.path;
  if (!path.empty() && !std::filesystem::exists(path))
    throw IoError(path, "", "a data set of depth maps or photographs", "nothing of that name");
  if (speaks(options)) path.empty() ? list() : explain(path);
  Json json = tool::jsonOf("formats");
  json["depth_maps"] = jsonOf(depthSetFormats(), path);
  json["photographs"] = jsonOf(imageSetFormats(), path);
  JsonReport(options, json).commit();
}

}  // namespace

void addFormats(CLI::App& app, Action& action) {
  CLI::App& sub =
      *app.add_subcommand("formats",
                          "List the formats of data sets, or say which of them a folder or file fits\n\n"
                          "Without PATH: each format with an example of its layout. With PATH: what fits, "
                          "and what the others miss.");
  sub.footer("vdbfuse formats\nvdbfuse formats scan/");
  const auto options = std::make_shared<FormatsOptions>();
  sub.add_option("PATH,--input", options->path, "Data set to look at")
      ->type_name("PATH")
      ->option_text("none");
  addJsonOption(sub, options->json, "Write the same as JSON");
  addRunOptions(sub, *options);
  sub.callback([&action, options] { action = [options] { run(*options); }; });
}

}  // namespace vdbfuse::tool
