// SPDX-License-Identifier: Apache-2.0
// vdbfuse stereo IMAGES OUTDIR: photographs to depth maps.
#include "vdbfuse/stereo/stereo.h"

#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"
#include "cli/number_check.h"
#include "cli/one_of.h"
#include "commands.h"
#include "json_file.h"
#include "output_folder.h"
#include "progress_line.h"
#include "run_options.h"
#include "stereo_arguments.h"
#include "stereo_preview.h"
#include "stereo_report.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/memory.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

struct Request : RunArguments {
  fs::path input, output;
  ImageReadOptions read;
  StereoOptions options;
  std::vector<double> box;
  std::string to = "mvsnet";
  std::size_t views = 0;
};

// Names that can be names of files: folders become parts of them; numbers where two would be the same.
void makeFileNames(std::vector<StereoView>& views) {
  std::set<std::string> names;
  for (StereoView& view : views) {
    std::replace(view.view.name.begin(), view.view.name.end(), '/', '_');
    names.insert(view.view.name);
  }
  for (std::size_t i = 0; i < views.size() && names.size() < views.size(); ++i)
    views[i].view.name = std::to_string(i);
}

void makeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw IoError(folder, "cannot be created: " + error.message());
}

void writePreviews(const fs::path& folder, const std::vector<StereoView>& views) {
  makeFolder(folder);
  parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      writePng(folder / (views[i].view.name + ".png"), stereoPreview(views[i].view));
  });
}

// Where readers of the folder look for them. MVSNet's views are numbered, COLMAP's have their names.
void writeMasks(const fs::path& folder, const std::vector<StereoView>& views, const std::string& format) {
  const auto has_mask = [](const StereoView& view) { return !view.view.map.mask.empty(); };
  if (std::none_of(views.begin(), views.end(), has_mask)) return;
  makeFolder(folder / "masks");
  ReadOptions read_back;
  read_back.format = format;
  const ViewSequence written = readDepthSet(folder, read_back).views;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!has_mask(views[i])) continue;
    const std::string& name = format == "mvsnet" ? written.header(i).name : views[i].view.name;
    writePng(folder / "masks" / (name + ".png"), views[i].view.map.mask);
  }
}

Json jsonOf(const Request& request, const ImageSet& set, const StereoSummary& summary) {
  Json json = tool::jsonOf("stereo");
  json["options"] = tool::jsonOf(request.options);
  json["options"]["input"] = request.input.string();
  json["options"]["masks"] = request.read.masks.empty() ? Json(nullptr) : Json(request.read.masks.string());
  json["options"]["to"] = request.to;
  const Pinhole& first = set.photographs.header(0).camera;
  json["input"] = {{"photographs", set.photographs.size()},
                   {"width", first.width},
                   {"height", first.height},
                   {"format", set.format}};
  json["views"] = tool::jsonOf(summary);
  json["notes"] = set.notes;
  return json;
}

// What differs from run to run is not in the folder.
Json withTimes(Json json, const StereoSummary& summary) {
  json["steps"] = stepsJson(summary.steps);
  json["peak_memory_bytes"] = peakMemoryBytes();
  return json;
}

void writeFolder(const fs::path& folder, const Request& request, const StereoResult& result,
                 const Progress& progress) {
  const std::vector<StereoView>& views = result.views;
  std::vector<ViewHeader> headers;
  for (const StereoView& view : views) headers.push_back(view.view);
  writeDepthSet(folder, request.to, {std::move(headers), [&](std::size_t i) { return views[i].view.map; }},
                {}, progress);
  writeMasks(folder, views, request.to);
  writePreviews(folder / "preview", result.views);
}

void printNotes(const Request& request, const ImageSet& set) {
  for (const std::string& note : set.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  if (request.options.hypotheses > 1)
    std::fprintf(stderr, "note: %s has no place for further depths of a pixel; vdbfuse fuse %s uses them\n",
                 request.to.c_str(), request.input.c_str());
}

// Images come and go by the hundred: taking their pages from the system anew each time costs a fifth of all.
void keepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

void run(Request request) {
  keepFreedMemory();
  const ThreadLimit threads(request.threads);
  refuseToReplace(request.output, request.input);
  refuseExistingJson(request);
  OutputFolder folder(request.output, request.overwrite ? Existing::Replace : Existing::Refuse);
  request.options.domain = boxOf(request.box);
  const ImageSet set = readPhotographs(request.input, request.read, request.views);
  if (!request.quiet) printNotes(request, set);
  const ProgressLine line(request.quiet, {{"matching", 2}, {"cross-checking", 5}, {"write", 2}});
  StereoResult result = computeDepthMaps(set.photographs, request.options, line.progress());
  const StereoSummary summary = summarise(result);
  makeFileNames(result.views);
  writeFolder(folder.temporaryPath(), request, result, line.progress());
  const Json json = jsonOf(request, set, summary);
  writeJson(folder.temporaryPath() / "stereo.json", json);
  JsonReport run_json(request, withTimes(json, summary));
  folder.commit();
  run_json.commit();
  if (speaks(request)) std::printf("%s", tableOf(summary).c_str());
}

std::vector<std::string> imageFormatNames() {
  std::vector<std::string> names;
  for (const ImageSetFormat& format : imageSetFormats()) names.emplace_back(format.name);
  return names;
}

void addInputOptions(CLI::App& app, Request& request) {
  app.option_defaults()->group("Input");
  app.add_option("--format", request.read.format, "Format of the input")
      ->transform(oneOf(imageFormatNames()))
      ->type_name("WORD")
      ->option_text("what the input looks like");
  app.add_option("--masks", request.read.masks,
                 "Folder of silhouettes NAME.png, black where the object is not")
      ->type_name("FOLDER")
      ->option_text("what lies in the data set");
  app.add_option("--views", request.views, "Use the first N photographs only")
      ->check(numberBetween(2, 1 << 30))
      ->type_name("N")
      ->option_text("all");
  app.add_option("--bbox", request.box, "Box in which depths are looked for")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,y0,z0,x1,y1,z1")
      ->option_text("what the data set says, or where the cameras look");
  app.add_option("--min-depth", request.options.min_depth, "Least depth that is looked for")
      ->check(nonNegativeNumber())
      ->type_name("LENGTH")
      ->option_text("what the data set says, or from the cameras");
  app.add_option("--max-depth", request.options.max_depth, "Largest depth that is looked for")
      ->check(nonNegativeNumber())
      ->type_name("LENGTH")
      ->option_text("what the data set says, or from the cameras");
}

}  // namespace

void addStereo(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand(
      "stereo",
      "Make depth maps with confidences from photographs\n\n"
      "Writes depth maps, confidences, cameras and pictures in the layout of MVSNet or COLMAP, a preview a "
      "photograph (picture, depths, confidences), and stereo.json. vdbfuse fuse takes the photographs, too.");
  sub.footer(
      "vdbfuse stereo photographs/ depths/\n"
      "vdbfuse fuse depths/ mesh.ply");
  auto request = std::make_shared<Request>();
  sub.add_option("IMAGES,--input", request->input, "Photographs with cameras")->type_name("PATH")->required();
  sub.add_option("OUTDIR,--output", request->output, "Folder to write")->type_name("FOLDER")->required();
  addInputOptions(sub, *request);
  addStereoOptions(sub, request->options, "Matching");
  sub.option_defaults()->group("Output");
  sub.add_option("--to", request->to, "Layout of the folder")
      ->transform(oneOf({"mvsnet", "colmap"}))
      ->type_name("WORD")
      ->capture_default_str();
  addJsonOption(sub, request->json, "Write stereo.json, with times and memory, here as well");
  addRunOptions(sub, *request);
  sub.callback([&action, request] {
    refuse("options", validate(request->options));
    action = [request] { run(*request); };
  });
}

}  // namespace vdbfuse::tool
