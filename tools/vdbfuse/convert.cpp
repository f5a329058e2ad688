// SPDX-License-Identifier: Apache-2.0
// vdbfuse convert INPUT OUTDIR --to FORMAT: a data set in another format.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "output_folder.h"
#include "progress_line.h"
#include "read_options.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

struct Request {
  fs::path input, output;
  std::string to;
  ReadArguments read;
  WriteOptions write;
  std::size_t views = 0;
  bool overwrite = false, quiet = false;
};

std::vector<std::string> writableFormats() {
  std::vector<std::string> names;
  for (const DepthSetFormat& format : depthSetFormats()) {
    if (format.write != nullptr) names.emplace_back(format.name);
  }
  return names;
}

// What was written, read as its readers would; the step is not in every format's files.
ReadOptions readBack(const Request& request) {
  ReadOptions options;
  options.format = request.to;
  return options;
}

void run(const Request& request) {
  DepthSet set = readInput(request.input, request.read);
  if (request.views > 0) set.views = set.views.first(request.views);
  refuseToReplace(request.output, request.input);
  OutputFolder output(request.output, request.overwrite ? Existing::Replace : Existing::Refuse);
  {
    const ProgressLine line(request.quiet);
    writeDepthSet(output.temporaryPath(), request.to, set.views, request.write, line.progress());
  }
  const DepthReading reading = readDepthSet(output.temporaryPath(), readBack(request)).reading;
  output.commit();
  if (request.quiet) return;
  if (request.write.depth_scale && reading.scale != *request.write.depth_scale)
    std::fprintf(stderr, "note: %s has no place for the step; tell its readers (--depth-scale %g)\n",
                 request.to.c_str(), *request.write.depth_scale);
  for (const std::string& note : set.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  std::printf("%s: %zu views, %s; %s\n", request.output.c_str(), set.views.size(), request.to.c_str(),
              depthText(reading).c_str());
}

}  // namespace

void addConvert(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand("convert", "Write a data set in another format");
  sub.footer(
      "Depths, poses, cameras, and confidences and pictures where the format has a place for them. Formats "
      "that\n"
      "hold whole numbers round to steps of --step.\n\n"
      "Example: vdbfuse convert scan/ workspace/ --to colmap");
  auto request = std::make_shared<Request>();
  sub.add_option("INPUT", request->input, "Data set: a folder or a file")->required();
  sub.add_option("OUTDIR", request->output, "Folder to write")->required();
  sub.add_option("--to", request->to, "Format to write")->required()->check(CLI::IsMember(writableFormats()));
  addReadOptions(sub, request->read);
  sub.add_option_function<double>(
         "--step", [request](double step) { request->write.depth_scale = step; },
         "Length of one step of formats that hold whole numbers; default: what their readers expect")
      ->check(CLI::PositiveNumber);
  sub.add_option("--views", request->views, "The first N views only")->check(CLI::PositiveNumber);
  sub.add_flag("--overwrite", request->overwrite, "Replace a folder that is not empty");
  sub.add_flag("--quiet", request->quiet, "Print errors only");
  sub.callback([&action, request] { action = [request] { run(*request); }; });
}

}  // namespace vdbfuse::tool
