// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/evaluation/evaluate.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/io/atomic_file.h"
#include "vdbfuse/io/mesh_file.h"

namespace vdbfuse::tool {
namespace {

using nlohmann::ordered_json;

struct Arguments {
  std::string mesh, truth, regions, json;
  EvaluateOptions options;
  int threads = 0;
};

// JSON has no infinity: an accuracy without a mesh is null.
ordered_json finiteOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json orNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

ordered_json toJson(const Arguments& arguments, const Evaluation& e) {
  ordered_json object;
  object["version"] = VDBFUSE_VERSION;
  object["command"] = "evaluate";
  ordered_json taus, precision, recall, fscore;
  for (const ScoreAtTau& score : e.scores) {
    taus.push_back(score.tau);
    precision.push_back(score.precision);
    recall.push_back(score.recall);
    fscore.push_back(score.fscore);
  }
  object["options"] = {{"mesh", arguments.mesh}, {"truth", arguments.truth}, {"tau", taus}};
  if (arguments.options.deep) object["options"]["deep"] = *arguments.options.deep;
  if (!arguments.regions.empty()) object["options"]["regions"] = arguments.regions;
  object["accuracy90"] = finiteOrNull(e.accuracy90);
  object["accuracy_rms"] = finiteOrNull(e.accuracy_rms);
  object["completeness"] = e.completeness;
  object["tau"] = taus;
  object["precision"] = precision;
  object["recall"] = recall;
  object["fscore"] = fscore;
  object["iou"] = orNull(e.iou);
  if (arguments.options.deep) {
    object["false_outside_volume_deep"] = orNull(e.false_outside_deep);
    object["false_inside_volume_deep"] = orNull(e.false_inside_deep);
  }
  object["vertices"] = e.topology.used_vertices;
  object["triangles"] = e.topology.triangles;
  object["components"] = e.topology.components;
  object["open_edges"] = e.topology.open_edges;
  object["nonmanifold_edges"] = e.topology.nonmanifold_edges;
  object["nonmanifold_vertices"] = e.topology.nonmanifold_vertices;
  object["inconsistent_edges"] = e.topology.inconsistent_edges;
  object["euler_number"] = e.topology.euler_number;
  object["closed"] = isClosedManifold(e.topology);
  object["regions"] = ordered_json::object();
  for (const RegionShare& region : e.regions) object["regions"][region.name] = orNull(region.share);
  return object;
}

void writeJson(AtomicFile& target, const ordered_json& object) {
  std::ofstream file(target.temporaryPath());
  file << object.dump(2) << '\n';
  file.close();
  if (!file) throw IoError(target.temporaryPath(), "cannot be written");
  target.commit();
}

void print(const Evaluation& e) {
  std::printf("accuracy      %.6g (90 %% of the surface), %.6g (rms)\n", e.accuracy90, e.accuracy_rms);
  std::printf("completeness  %.2f %%\n", 100 * e.completeness);
  std::printf("%12s %10s %10s %10s\n", "tau", "precision", "recall", "F-score");
  for (const ScoreAtTau& s : e.scores) {
    std::printf("%12.6g %8.2f %% %8.2f %% %8.2f %%\n", s.tau, 100 * s.precision, 100 * s.recall,
                100 * s.fscore);
  }
  if (e.iou) std::printf("IoU           %.4f\n", *e.iou);
  if (e.false_outside_deep && e.false_inside_deep) {
    std::printf("deep          %.3f %% of the true volume lost, %.3f %% invented\n",
                100 * *e.false_outside_deep, 100 * *e.false_inside_deep);
  }
  std::printf("mesh          %zu triangles, %zu components, %zu open edges, %zu non-manifold edges: %s\n",
              e.topology.triangles, e.topology.components, e.topology.open_edges,
              e.topology.nonmanifold_edges,
              isClosedManifold(e.topology) ? "closed manifold" : "not a closed manifold");
  for (const RegionShare& region : e.regions) {
    const char* verb = region.expect == Expectation::Outside ? "open" : "kept";
    if (region.share) {
      std::printf("region        %s: %.2f %% %s\n", region.name.c_str(), 100 * *region.share, verb);
    } else {
      std::printf("region        %s: nowhere %s in the truth\n", region.name.c_str(), verb);
    }
  }
}

void run(const Arguments& arguments) {
  const ThreadLimit limit(arguments.threads);
  // Before the work, so that a place that cannot be written to is known at once.
  std::optional<AtomicFile> json;
  if (!arguments.json.empty()) json.emplace(arguments.json);
  const std::vector<Region> regions =
      arguments.regions.empty() ? std::vector<Region>{} : readRegions(arguments.regions);
  const TriangleMesh truth = readMesh(arguments.truth), mesh = readMesh(arguments.mesh);
  if (truth.triangles.empty()) throw IoError(arguments.truth, "", "a mesh with triangles", "none");
  const Evaluation evaluation = evaluate(mesh, truth, arguments.options, regions);
  print(evaluation);
  if (json) writeJson(*json, toJson(arguments, evaluation));
}

}  // namespace

void addEvaluate(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("evaluate",
                         "Compare a mesh with the truth.\n"
                         "Example: vdbfuse evaluate out.ply truth.ply --tau 0.01,0.02 --json out.json");
  const auto arguments = std::make_shared<Arguments>();
  command->add_option("mesh", arguments->mesh, "The mesh to judge: .ply, .obj or .stl")->required();
  command->add_option("truth", arguments->truth, "The true surface, in the same coordinates and unit")
      ->required();
  // Without extra arguments, so that --tau does not swallow the files after it.
  command
      ->add_option("--tau", arguments->options.taus,
                   "Distances for precision, recall and F-score; the first also for completeness "
                   "[1 % of the diagonal of the truth's bounding box]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--deep", arguments->options.deep,
                   "Also the volume lost and invented further than this from the true surface")
      ->check(CLI::NonNegativeNumber);
  command->add_option(
      "--regions", arguments->regions,
      "JSON file of named regions known to be outside or inside: prints the share kept or open");
  command->add_option(
      "--json", arguments->json,
      "Write the figures to this file (replaced if it exists); precision, recall and fscore are "
      "arrays, one entry a tau");
  command->add_option("--threads", arguments->threads, "Number of threads [all]")
      ->check(CLI::NonNegativeNumber);
  command->callback([arguments, &action] { action = [arguments] { run(*arguments); }; });
}

}  // namespace vdbfuse::tool
