// SPDX-License-Identifier: Apache-2.0
#include "compare/methods.h"

#include <algorithm>

#include "compare/slices.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/mesh_file.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

ReconstructOptions optionsOf(const std::string& name, ReconstructOptions options) {
  options.method = name == "tsdf" ? Method::Tsdf : Method::Visibility;
  if (name == "constant") options.evidence.rule = EvidenceRule::Constant;
  options.grids = ReconstructOptions::Grids::Keep;
  return options;
}

// The plan is that of the method that needs most.
ScanPlan planFor(const ViewSequence& views, const std::vector<MethodToCompare>& methods, Words words,
                 const Progress& progress) {
  const auto cut = std::find_if(methods.begin(), methods.end(), [](const MethodToCompare& method) {
    return method.options.method == Method::Visibility;
  });
  const ReconstructOptions& options = (cut == methods.end() ? methods.front() : *cut).options;
  ScanPlan plan = planReconstruction(views, options, progress);
  if (words == Words::Print) printPlan(plan, options.method);
  return plan;
}

double meanSupport(const TriangleMesh& mesh) {
  const std::vector<double> areas = vertexAreas(mesh);
  double sum = 0, all = 0;
  for (std::size_t v = 0; v < areas.size(); ++v) sum += areas[v] * mesh.support[v], all += areas[v];
  return all > 0 ? sum / all : 0;
}

MethodRecord recordOf(const ComparedMethod& method, const std::vector<StepTime>& shared) {
  const Reconstruction& result = method.result;
  MethodRecord record;
  record.name = method.name;
  record.mesh = fs::path("meshes") / (method.name + ".ply");
  record.seconds = totalSeconds(result.steps);
  record.shared_seconds = totalSeconds(shared);
  record.own_peak_memory = record.peak_memory = method.peak_memory_bytes;
  for (const StepTime& step : shared)
    record.peak_memory = std::max(record.peak_memory, step.peak_memory_bytes);
  record.measured = method.measured;
  record.topology = topology(result.mesh);
  if (result.cut) record.invented_share = result.invented_area_share;
  record.mean_support = meanSupport(result.mesh);
  return record;
}

// Takes each method as it is done and keeps what is small.
class Recorder {
 public:
  Recorder(const CompareRequest& request, const fs::path& folder, const DepthSet& set,
           const std::vector<StepTime>& shared, const Progress& progress, CompareRun& run)
      : request_(request), folder_(folder), set_(set), shared_(shared), progress_(progress), run_(run) {
    if (request.color == "auto") pictures_ = readPictures(request.input, request.sensor);
  }

  void take(ComparedMethod method) {
    Reconstruction& result = method.result;
    if (!pictures_.empty()) colorReconstruction(pictures_, result, progress_);
    if (run_.methods.empty()) describeRun(result);
    MethodRecord record = recordOf(method, shared_);
    record.fuse = fuseJson(result, {request_.input, "", set_.format, set_.views.size(), method.options,
                                    record.topology, std::nullopt});
    record.fuse["peak_memory_bytes"] = record.peak_memory;
    writeSlices(folder_, {run_.plane, run_.box}, result.grids, record);
    writeMesh(folder_ / record.mesh, result.mesh);
    run_.methods.push_back(std::move(record));
  }

 private:
  // What the first method decides for all of them.
  void describeRun(const Reconstruction& result) {
    run_.voxel = result.grid.voxel;
    run_.calibration = result.calibration;
    run_.width = result.width, run_.height = result.height;
    run_.box = result.grid.domain;
    run_.plane = choosePlane(request_.slice, boundingBox(result.mesh), run_.voxel);
  }

  const CompareRequest& request_;
  const fs::path& folder_;
  const DepthSet& set_;
  const std::vector<StepTime>& shared_;
  const Progress& progress_;
  CompareRun& run_;
  ViewSequence pictures_;
};

}  // namespace

std::vector<MethodToCompare> methodsOf(const CompareRequest& request) {
  std::vector<MethodToCompare> methods;
  for (const std::string& name : request.methods) {
    const bool twice = std::any_of(methods.begin(), methods.end(),
                                   [&](const MethodToCompare& other) { return other.name == name; });
    if (twice) throw InvalidArgument("--methods", "'" + name + "' is named twice");
    methods.push_back({name, optionsOf(name, request.options)});
  }
  return methods;
}

CompareRun runMethods(const CompareRequest& request, const fs::path& folder, const Progress& progress) {
  const Words words = request.quiet ? Words::Keep : Words::Print;
  const std::vector<MethodToCompare> methods = methodsOf(request);
  const DepthSet set = readScan(request.input, request.sensor, words);
  if (words == Words::Print) warnOf(set);
  ScanPlan plan = planFor(set.views, methods, words, progress);
  JudgedScan scan = judgeScan(set.views, methods.front().options, std::move(plan), progress);
  const std::vector<StepTime> shared = scan.steps;
  CompareRun run;
  run.format = set.format, run.views = set.views.size();
  for (std::size_t i = 0; i < set.views.size(); ++i) run.cameras.push_back(set.views.header(i));
  fs::create_directory(folder / "meshes"), fs::create_directory(folder / "slices");
  Recorder recorder(request, folder, set, shared, progress, run);
  compareMethods(
      std::move(scan), methods, [&](ComparedMethod method) { recorder.take(std::move(method)); }, progress);
  return run;
}

}  // namespace vdbfuse::tool
