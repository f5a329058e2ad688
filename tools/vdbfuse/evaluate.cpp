// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/evaluation/evaluate.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

#include "cli/number_check.h"
#include "commands.h"
#include "evaluation_json.h"
#include "interrupts.h"
#include "run_options.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/io/atomic_file.h"
#include "vdbfuse/io/mesh_file.h"

namespace vdbfuse::tool {
namespace {

struct Arguments : RunArguments {
  std::string mesh, truth, regions;
  EvaluateOptions options;
};

Json toJson(const Arguments& arguments, const Evaluation& e) {
  Json object = jsonOf("evaluate");
  object["options"] = {{"mesh", arguments.mesh}, {"truth", arguments.truth}, {"tau", tausOf(e)}};
  if (arguments.options.deep) object["options"]["deep"] = *arguments.options.deep;
  if (!arguments.regions.empty()) object["options"]["regions"] = arguments.regions;
  object.update(evaluationJson(e));
  if (arguments.options.deep) {
    object["false_outside_volume_deep"] = orNull(e.false_outside_deep);
    object["false_inside_volume_deep"] = orNull(e.false_inside_deep);
  }
  return object;
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
  if (isFile(arguments.json)) const AtomicFile can_be_written(arguments.json);
  const std::vector<Region> regions =
      arguments.regions.empty() ? std::vector<Region>{} : readRegions(arguments.regions);
  const TriangleMesh truth = readMesh(arguments.truth), mesh = readMesh(arguments.mesh);
  if (truth.triangles.empty()) throw IoError(arguments.truth, "", "a mesh with triangles", "none");
  const Evaluation evaluation = evaluate(mesh, truth, arguments.options, regions);
  JsonReport json(arguments, toJson(arguments, evaluation));
  stopIfInterrupted();
  if (speaks(arguments)) print(evaluation);
  json.commit();
}

}  // namespace

void addEvaluate(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand(
      "evaluate",
      "Compare a mesh with the truth\n\n"
      "Accuracy, completeness, precision, recall and F-score at the distances of --tau, volume in common, "
      "topology, and the regions of a scene that should be kept or open.");
  sub.footer("vdbfuse evaluate out.ply truth.ply --tau 0.01,0.02 --json out.json");
  const auto arguments = std::make_shared<Arguments>();
  sub.add_option("MESH,--input", arguments->mesh, "The mesh to judge: .ply, .obj or .stl")
      ->type_name("FILE")
      ->required();
  sub.add_option("TRUTH,--truth", arguments->truth, "The true surface, in the same coordinates and unit")
      ->type_name("FILE")
      ->required();
  sub.option_defaults()->group("Measures");
  // Without extra arguments, so that --tau does not swallow the files after it.
  sub.add_option("--tau", arguments->options.taus,
                 "Distances for precision, recall and F-score, with commas between them; the first also for "
                 "completeness")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(positiveNumber())
      ->type_name("LENGTH")
      ->option_text("1 % of the diagonal of the truth's bounding box");
  sub.add_option("--deep", arguments->options.deep,
                 "Also the volume lost and invented further than this from the true surface")
      ->check(nonNegativeNumber())
      ->type_name("LENGTH")
      ->option_text("none");
  sub.add_option("--regions", arguments->regions,
                 "JSON file of named regions known to be outside or inside: prints the share kept or open")
      ->type_name("FILE")
      ->option_text("none");
  addJsonOption(
      sub, arguments->json,
      "Write the figures to this file, replaced if it exists; precision, recall and fscore are arrays, "
      "one entry a tau");
  addRunOptions(sub, *arguments);
  sub.callback([arguments, &action] { action = [arguments] { run(*arguments); }; });
}

}  // namespace vdbfuse::tool
