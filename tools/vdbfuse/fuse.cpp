// SPDX-License-Identifier: Apache-2.0
// vdbfuse fuse INPUT OUT: depth maps, or photographs, to a surface.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "arguments.h"
#include "commands.h"
#include "fuse_explain.h"
#include "fuse_options.h"
#include "fuse_report.h"
#include "interrupts.h"
#include "progress_line.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/io/atomic_file.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

void requireNew(const fs::path& path, const FuseRequest& request) {
  if (path.empty()) return;
  if (!request.overwrite) refuseExisting(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw IoError(path, "cannot be written: there is no folder " + folder.string());
  const AtomicFile can_be_written(path);  // never committed: leaves nothing
}

void writeOutputs(const FuseRequest& request, const Reconstruction& result, const FuseContext& context,
                  std::vector<Output> outputs) {
  if (!request.grids.empty()) {
    outputs.push_back({request.grids, [&](const fs::path& path) {
                         std::vector<const ScalarGrid*> grids;
                         for (const ScalarGrid& grid : result.grids) grids.push_back(&grid);
                         writeGrids(path, grids);
                       }});
  }
  if (isFile(request.json)) {
    outputs.push_back(
        {request.json, [&](const fs::path& path) { writeJson(path, fuseJson(result, context)); }});
  }
  outputs.push_back({request.output, [&](const fs::path& path) { writeMesh(path, result.mesh); }});
  writeTogether(outputs);
}

// Millions of pixels, as the plan loads them.
double megapixels(const ViewSequence& views, const ScanPlan& plan) {
  double pixels = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Projection& p = views.header(i).projection;
    const int factor = plan.reduction.empty() ? 1 : plan.reduction[i];
    pixels += 1e-6 * imageWidth(p) * imageHeight(p) / (factor * factor);
  }
  return pixels;
}

// Seconds of each step on the machine and the scans that they were measured on; only their shares count.
std::vector<StepShare> expectedSteps(const ViewSequence& views, const ScanPlan& plan,
                                     const FuseRequest& request) {
  const double pixels = megapixels(views, plan), cells = 1e-6 * plan.cells;
  std::vector<StepShare> steps = {{"load views", 0.03 * pixels}};
  if (request.judgement.empty())
    steps.insert(steps.end(), {{"calibrate noise", 0.04 * pixels},
                               {"analyse surfaces", 0.13 * pixels},
                               {"judge pixels", 0.18 * pixels},
                               {"weigh views", 0.015 * pixels},
                               {"look for denial", 0.12 * pixels}});
  if (request.reconstruct.method == Method::Tsdf) {
    steps.insert(steps.end(), {{"integrate", cells}, {"connect triangles", 0.4 * cells}});
  } else {
    steps.insert(steps.end(), {{"allocate grid", 0.2 * cells},
                               {"count agreement", 1.1 * cells},
                               {"evidence", 6.2 * cells},
                               {"minimum cut", 1.3 * cells},
                               {"place surface", 1.3 * cells},
                               {"complete surface", 4.6 * cells},
                               {"refine surface", 1.3 * cells},
                               {"connect triangles", 0.3 * cells}});
  }
  if (request.color == "auto") steps.push_back({"colour", 0.18 * pixels});
  return steps;
}

JudgedScan judged(const DepthSet& set, FuseRequest& request, ProgressLine& line) {
  const Progress& progress = line.progress();
  ScanPlan plan = planReconstruction(set.views, request.reconstruct, progress);
  line.expect(expectedSteps(set.views, plan, request));
  if (!request.quiet) printPlan(plan, request.reconstruct.method);
  if (request.judgement.empty()) return judgeScan(set.views, request.reconstruct, std::move(plan), progress);
  JudgedScan scan = readJudgement(request.judgement, set.views, std::move(plan), progress);
  request.reconstruct.noise_shape = scan.judgement.judged.sensor.shape;
  return scan;
}

Words wordsOf(const FuseRequest& request) { return request.quiet ? Words::Keep : Words::Print; }

// What is fused. Depth maps are read without their pictures, which colour the mesh at the end.
struct Input {
  DepthSet set;
  std::optional<StereoSummary> stereo;  ///< of photographs
};

Input readInput(FuseRequest& request, const Progress& progress) {
  if (!takesPhotographs(request.input, request.sensor, request.photographs)) {
    Input input{readScan(request.input, request.sensor, wordsOf(request)), std::nullopt};
    if (!request.quiet) warnOf(input.set);
    return input;
  }
  MatchedScan scan = matchPhotographs(request.input, request.sensor, request.photographs, request.reconstruct,
                                      wordsOf(request), progress);
  return {std::move(scan.set), std::move(scan.stereo)};
}

ViewSequence picturesOf(const FuseRequest& request, const Input& input) {
  return input.stereo ? withPictures(input.set.views) : readPictures(request.input, request.sensor);
}

void requireOutputs(const FuseRequest& request) {
  if (request.explain) return;
  requireMeshFormat(request.output);
  for (const fs::path& path : {request.output, request.grids}) requireNew(path, request);
  if (isFile(request.json)) requireNew(request.json, request);
}

void fuse(FuseRequest request, const CLI::App& command, Action& action) {
  const ThreadLimit threads(request.threads);
  requireOutputs(request);
  resolve(request);
  ProgressLine line(request.quiet);
  const Input input = readInput(request, line.progress());
  JudgedScan scan = judged(input.set, request, line);
  action.found = foundValues(request, scan, resolveParameters(scan, request.reconstruct), input.set.format);
  if (request.explain) return;
  Reconstruction result = reconstruct(std::move(scan), request.reconstruct, line.progress());
  if (request.color == "auto") {
    const ViewSequence pictures = picturesOf(request, input);
    if (!pictures.empty()) colorReconstruction(pictures, result, line.progress());
  }
  if (input.stereo)
    result.steps.insert(result.steps.begin(), input.stereo->steps.begin(), input.stereo->steps.end());
  const FuseContext context{
      request.input,       request.judgement,     input.set.format, input.set.views.size(),
      request.reconstruct, topology(result.mesh), input.stereo};
  stopIfInterrupted();
  writeOutputs(request, result, context, takeConfig(command, action));
  if (request.json == "-") std::printf("%s\n", jsonText(fuseJson(result, context)).c_str());
  if (speaks(request)) printFuseReport(result, context, request.output);
}

}  // namespace

void addFuse(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand(
      "fuse",
      "Turn depth maps with poses, or photographs with cameras, into a surface\n\n"
      "What the views say of each place, visible or hidden, decides what is solid: a global minimum cut "
      "gives a "
      "closed surface. With --method tsdf: signed distances by Curless and Levoy, open where nothing was "
      "measured.\n\n"
      "Everything that is not given is found from the data; --explain says what, and why.");
  sub.footer(
      "vdbfuse fuse scan/ mesh.ply --voxel 0.002\n"
      "vdbfuse fuse photographs/ mesh.glb\n"
      "vdbfuse fuse scan/ --explain\n"
      "vdbfuse fuse scan/ mesh.ply --save-config run.toml\n"
      "vdbfuse fuse --config run.toml --output again.ply");
  auto request = std::make_shared<FuseRequest>();
  addFuseOptions(sub, *request);
  sub.callback([&sub, &action, request] {
    refuse("options", validate(request->photographs.stereo));
    action = [&sub, &action, request] { fuse(*request, sub, action); };
  });
}

}  // namespace vdbfuse::tool
