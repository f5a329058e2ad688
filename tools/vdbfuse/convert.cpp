// SPDX-License-Identifier: Apache-2.0
// vdbfuse convert INPUT OUTDIR --to FORMAT: a data set in another format.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/number_check.h"
#include "cli/one_of.h"
#include "commands.h"
#include "output_folder.h"
#include "progress_line.h"
#include "read_options.h"
#include "run_options.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

struct Request : RunArguments {
  fs::path input, output;
  std::string to;
  ReadArguments read;
  WriteOptions write;
  std::size_t views = 0;
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

Json jsonOf(const Request& request, const DepthSet& set, const DepthReading& reading) {
  Json json = tool::jsonOf("convert");
  json["options"] = tool::jsonOf(request.read);
  json["options"]["input"] = request.input.string();
  json["options"]["to"] = request.to;
  json["input"] = {{"views", set.views.size()}, {"format", set.format}};
  json["written"] = {{"path", request.output.string()},
                     {"stored", reading.stored},
                     {"scale", reading.scale},
                     {"invalid", reading.invalid}};
  json["notes"] = set.notes;
  return json;
}

void run(const Request& request) {
  refuseExistingJson(request);
  DepthSet set = readInput(request.input, request.read);
  if (request.views > 0) set.views = set.views.first(request.views);
  refuseToReplace(request.output, request.input);
  OutputFolder output(request.output, request.overwrite ? Existing::Replace : Existing::Refuse);
  {
    const ProgressLine line(request.quiet, {{"write", 1}});
    writeDepthSet(output.temporaryPath(), request.to, set.views, request.write, line.progress());
  }
  const DepthReading reading = readDepthSet(output.temporaryPath(), readBack(request)).reading;
  JsonReport json(request, jsonOf(request, set, reading));
  output.commit();
  json.commit();
  if (request.quiet) return;
  if (request.write.depth_scale && reading.scale != *request.write.depth_scale)
    std::fprintf(stderr, "note: %s has no place for the step; tell its readers (--depth-scale %g)\n",
                 request.to.c_str(), *request.write.depth_scale);
  for (const std::string& note : set.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  if (speaks(request))
    std::printf("%s: %zu views, %s; %s\n", request.output.c_str(), set.views.size(), request.to.c_str(),
                depthText(reading).c_str());
}

}  // namespace

void addConvert(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand("convert",
                                      "Write a data set in another format\n\n"
                                      "Depths, poses, cameras, and confidences and pictures where the format "
                                      "has a place for them. Formats that "
                                      "hold whole numbers round to steps of --step.");
  sub.footer("vdbfuse convert scan/ workspace/ --to colmap");
  auto request = std::make_shared<Request>();
  sub.add_option("INPUT,--input", request->input, "Data set")->type_name("PATH")->required();
  sub.add_option("OUTDIR,--output", request->output, "Folder to write")->type_name("FOLDER")->required();
  sub.option_defaults()->group("Output");
  sub.add_option("--to", request->to, "Format to write")
      ->required()
      ->transform(oneOf(writableFormats()))
      ->type_name("WORD");
  sub.add_option_function<double>(
         "--step", [request](double step) { request->write.depth_scale = step; },
         "Length of one step of formats that hold whole numbers")
      ->check(positiveNumber())
      ->type_name("LENGTH")
      ->option_text("what the format's readers expect");
  addReadOptions(sub, request->read);
  sub.add_option("--views", request->views, "The first N views only")
      ->check(positiveNumber())
      ->type_name("N")
      ->option_text("all");
  addJsonOption(sub, request->json, "Write what was done as one JSON object");
  addRunOptions(sub, *request);
  sub.callback([&action, request] { action = [request] { run(*request); }; });
}

}  // namespace vdbfuse::tool
