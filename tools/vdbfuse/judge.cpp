// SPDX-License-Identifier: Apache-2.0
// vdbfuse judge INPUT OUTDIR: what each pixel of a data set is worth.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "commands.h"
#include "json_file.h"
#include "memory_option.h"
#include "output_folder.h"
#include "progress_line.h"
#include "run_options.h"
#include "sensor_options.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/memory.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

struct Request : RunArguments {
  fs::path input, output;
  SensorArguments sensor;
  ReconstructOptions options;
};

// judgement.json, and what differs from run to run.
Json runJson(const JudgedScan& scan, const JudgementOrigin& origin) {
  Json json = Json::parse(judgementJson(scan, origin));
  json["steps"] = stepsJson(scan.steps);
  json["peak_memory_bytes"] = peakMemoryBytes();
  return json;
}

void run(Request request) {
  const ThreadLimit threads(request.threads);
  refuseToReplace(request.output, request.input);
  refuseExistingJson(request);
  OutputFolder folder(request.output, request.overwrite ? Existing::Replace : Existing::Refuse);
  resolve(request.sensor, request.options);
  const DepthSet set = readScan(request.input, request.sensor, request.quiet ? Words::Keep : Words::Print);
  const ProgressLine line(request.quiet, {{"load views", 3},
                                          {"calibrate noise", 4},
                                          {"analyse surfaces", 13},
                                          {"judge pixels", 18},
                                          {"weigh views", 1.5},
                                          {"look for denial", 12}});
  const JudgedScan scan = judgeScan(set.views, request.options, line.progress());
  const JudgementOrigin origin{VDBFUSE_VERSION, request.input.string(), set.format};
  writeJudgement(folder.temporaryPath(), scan, origin);
  JsonReport json(request, runJson(scan, origin));
  folder.commit();
  json.commit();
  if (speaks(request)) std::printf("%s", judgementText(scan).c_str());
}

}  // namespace

void addJudge(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand(
      "judge",
      "Say how far each pixel of depth maps can be believed\n\n"
      "Writes a picture a view (white: believed, black: wrong or not measured), judgement.json and "
      "judgement.txt "
      "(noise, learned curve of the confidence, weights), and outliers/ for another run.");
  sub.footer(
      "vdbfuse judge scan/ judged/\n"
      "vdbfuse fuse scan/ mesh.ply --judgement judged/");
  auto request = std::make_shared<Request>();
  sub.add_option("INPUT,--input", request->input, "Data set of depth maps")->type_name("PATH")->required();
  sub.add_option("OUTDIR,--output", request->output, "Folder to write")->type_name("FOLDER")->required();
  addSensorOptions(sub, request->sensor, request->options);
  addJsonOption(sub, request->json, "Write judgement.json, with times and memory, here as well");
  addMemoryOption(sub, request->options.memory);
  addRunOptions(sub, *request);
  sub.callback([&action, request] { action = [request] { run(*request); }; });
}

}  // namespace vdbfuse::tool
