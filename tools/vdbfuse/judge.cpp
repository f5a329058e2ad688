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
#include "sensor_options.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/memory.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

struct Request {
  fs::path input, output, json;
  SensorArguments sensor;
  ReconstructOptions options;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

// judgement.json, and what differs from run to run.
Json runJson(const JudgedScan& scan, const JudgementOrigin& origin) {
  Json json = Json::parse(judgementJson(scan, origin));
  json["steps"] = Json::array();
  for (const StepTime& s : scan.steps)
    json["steps"].push_back({{"name", s.name}, {"seconds", s.seconds}, {"cpu_seconds", s.cpu_seconds}});
  json["peak_memory_bytes"] = peakMemoryBytes();
  return json;
}

void run(Request request) {
  const ThreadLimit threads(request.threads);
  refuseToReplace(request.output, request.input);
  if (!request.json.empty() && !request.overwrite) refuseExisting(request.json);
  OutputFolder folder(request.output, request.overwrite ? Existing::Replace : Existing::Refuse);
  resolve(request.sensor, request.options);
  const DepthSet set = readScan(request.input, request.sensor, request.quiet ? Words::Keep : Words::Print);
  const ProgressLine line(request.quiet);
  const JudgedScan scan = judgeScan(set.views, request.options, line.progress());
  const JudgementOrigin origin{VDBFUSE_VERSION, request.input.string(), set.format};
  writeJudgement(folder.temporaryPath(), scan, origin);
  if (!request.json.empty()) writeJson(request.json, runJson(scan, origin));
  folder.commit();
  if (!request.quiet) std::printf("%s", judgementText(scan).c_str());
}

}  // namespace

void addJudge(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand("judge", "How far each pixel of depth maps can be believed");
  sub.footer(
      "Writes a picture a view (white: believed, black: wrong or not measured), judgement.json and\n"
      "judgement.txt (noise, learned curve of the confidence, weights), and outliers/ for another run.\n\n"
      "Example: vdbfuse judge scan/ judged/ && vdbfuse fuse scan/ mesh.ply --judgement judged/");
  auto request = std::make_shared<Request>();
  sub.add_option("INPUT", request->input, "Data set: a folder or a file")->required();
  sub.add_option("OUTDIR", request->output, "Folder to write")->required();
  addSensorOptions(sub, request->sensor, request->options);
  sub.add_option("--json", request->json, "Write judgement.json, with times and memory, here as well");
  addMemoryOption(sub, request->options.memory);
  sub.add_option("--threads", request->threads, "Number of threads; 0: all processors")
      ->check(CLI::NonNegativeNumber);
  sub.add_flag("--overwrite", request->overwrite, "Replace existing outputs");
  sub.add_flag("--quiet", request->quiet, "Print errors only");
  sub.callback([&action, request] { action = [request] { run(*request); }; });
}

}  // namespace vdbfuse::tool
