// SPDX-License-Identifier: Apache-2.0
// vdbfuse.fuse(): depth maps to a surface, in the steps of the command line's.
#include "python/fuse.h"

#include <algorithm>

#include "python/data_set.h"
#include "python/long_call.h"
#include "python/module.h"
#include "python/report.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/pipeline/judgement_folder.h"

namespace vdbfuse::python {
namespace {

JudgedScan judged(const ViewSequence& views, FuseRequest& request, const Progress& progress) {
  ScanPlan plan = planReconstruction(views, request.options, progress);
  if (request.judgement.empty()) return judgeScan(views, request.options, std::move(plan), progress);
  JudgedScan scan = readJudgement(request.judgement, views, std::move(plan), progress);
  request.options.noise_shape = scan.judgement.judged.sensor.shape;
  return scan;
}

// What is known of depth maps from photographs.
void useNoiseOf(const DataSet& data, ReconstructOptions& options) {
  if (!options.noise && options.noise_scale == 0) options.noise = data.noise;
  if (data.window_px > 0) options.window_px = data.window_px;
}

Reconstruction reconstructed(const DataSet& data, FuseRequest& request, const Progress& progress) {
  const ThreadLimit threads(request.threads);
  useNoiseOf(data, request.options);
  Reconstruction result = reconstruct(judged(data.set.views, request, progress), request.options, progress);
  if (!request.has_colors) return result;
  const ViewSequence pictures = data.pictures();
  if (!pictures.load(0).map.color.empty()) colorReconstruction(pictures, result, progress);
  return result;
}

std::shared_ptr<Mesh> fuse(const DataSet& data, const py::object& progress, const py::kwargs& keywords) {
  FuseRequest request;
  applyOptions("fuse", fuseOptions(), keywords, request);
  return meshOf(
      longCall(progress, [&](const Progress& inner) { return reconstructed(data, request, inner); }));
}

}  // namespace

std::shared_ptr<Mesh> meshOf(Reconstruction result) {
  auto mesh = makeMesh(std::move(result.mesh));
  mesh->report = reportOf(result);
  if (!result.grids.empty())
    mesh->grids = std::make_shared<const std::vector<ScalarGrid>>(std::move(result.grids));
  return mesh;
}

void bindFuse(py::module_& module) {
  module.def("fuse", fuse, "data"_a, "progress"_a);
  module.def("fuse_option_names", [] { return namesOf(fuseOptions()); });
}

}  // namespace vdbfuse::python
