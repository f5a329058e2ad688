// SPDX-License-Identifier: Apache-2.0
// vdbfuse.evaluate(): a mesh against the truth, as the members of the JSON file of vdbfuse evaluate.
#include "vdbfuse/evaluation/evaluate.h"

#include <cmath>
#include <filesystem>
#include <vector>

#include "python/long_call.h"
#include "python/mesh.h"
#include "python/module.h"

namespace vdbfuse::python {
namespace {

// None where the tool's JSON has null.
py::object finiteOrNone(double value) {
  return std::isfinite(value) ? py::object(py::float_(value)) : py::none();
}

py::dict dictOf(const Evaluation& e) {
  std::vector<double> tau, precision, recall, fscore;
  for (const ScoreAtTau& score : e.scores) {
    tau.push_back(score.tau), precision.push_back(score.precision);
    recall.push_back(score.recall), fscore.push_back(score.fscore);
  }
  py::dict regions;
  for (const RegionShare& region : e.regions) regions[py::str(region.name)] = py::cast(region.share);
  py::dict result("accuracy90"_a = finiteOrNone(e.accuracy90),
                  "accuracy_rms"_a = finiteOrNone(e.accuracy_rms), "completeness"_a = e.completeness,
                  "tau"_a = tau, "precision"_a = precision, "recall"_a = recall, "fscore"_a = fscore,
                  "iou"_a = e.iou);
  if (e.false_outside_deep) result["false_outside_volume_deep"] = *e.false_outside_deep;
  if (e.false_inside_deep) result["false_inside_volume_deep"] = *e.false_inside_deep;
  const TopologyReport& t = e.topology;
  result["vertices"] = t.used_vertices, result["triangles"] = t.triangles;
  result["components"] = t.components, result["open_edges"] = t.open_edges;
  result["nonmanifold_edges"] = t.nonmanifold_edges, result["nonmanifold_vertices"] = t.nonmanifold_vertices;
  result["inconsistent_edges"] = t.inconsistent_edges, result["euler_number"] = t.euler_number;
  result["closed"] = isClosedManifold(t), result["regions"] = regions;
  return result;
}

py::dict evaluateMesh(const Mesh& mesh, const Mesh& truth, const std::vector<double>& tau,
                      std::optional<double> deep, const std::optional<std::filesystem::path>& regions,
                      std::size_t samples, const py::object& progress) {
  EvaluateOptions options;
  options.taus = tau, options.deep = deep, options.samples = samples;
  return dictOf(longCall(progress, [&](const Progress&) {
    return evaluate(mesh.mesh, truth.mesh, options, regions ? readRegions(*regions) : std::vector<Region>());
  }));
}

}  // namespace

void bindEvaluate(py::module_& module) {
  module.def("evaluate", evaluateMesh, "mesh"_a, "truth"_a, "tau"_a, "deep"_a, "regions"_a, "samples"_a,
             "progress"_a);
}

}  // namespace vdbfuse::python
