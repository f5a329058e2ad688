// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare INPUT OUTDIR: several methods on one scan, side by side in a page.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "arguments.h"
#include "cli/number_check.h"
#include "cli/one_of.h"
#include "commands.h"
#include "compare/methods.h"
#include "compare/page.h"
#include "compare/pictures.h"
#include "interrupts.h"
#include "json_file.h"
#include "memory_option.h"
#include "output_folder.h"
#include "progress_line.h"
#include "render_slice.h"
#include "run_options.h"
#include "text_file.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/io/mesh_file.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLargestPage = 20'000'000;  // bytes

TriangleMesh readReference(const fs::path& path) {
  if (path.empty()) return {};
  TriangleMesh reference = readMesh(path);
  if (reference.triangles.empty()) throw IoError(path, "", "a mesh with triangles", "none");
  return reference;
}

// All that can be refused before the work begins.
void check(const CompareRequest& request) {
  refuseToReplace(request.output, request.input);
  if (!request.reference.empty()) refuseToReplace(request.output, request.reference, "the reference");
  refuseExistingJson(request);
  if (request.slice != "auto") parsePlane(request.slice);
  if (!request.taus.empty() && request.reference.empty())
    throw InvalidArgument("--tau", "needs --reference: distances are measured from it");
  methodsOf(request);
}

// The page with meshes as fine as asked for, or as its size allows. Returns what compare.json holds.
Json writePage(const CompareRequest& request, const fs::path& folder, const CompareRun& run,
               const MeasuredMeshes& measured, const ComparePictures& pictures, const Progress& progress) {
  std::size_t triangles = request.triangles;
  std::vector<EmbeddedMesh> embedded = embedMeshes(measured, triangles, progress);
  std::string page = comparePage(request, folder, run, measured, pictures, embedded);
  while (page.size() >= kLargestPage && triangles > 1000) {
    triangles = triangles * 2 / 3;
    embedded = embedMeshes(measured, triangles, progress);
    page = comparePage(request, folder, run, measured, pictures, embedded);
  }
  fs::create_directory(folder / "viewer");
  for (const EmbeddedMesh& mesh : embedded)
    writeText(folder / "viewer" / (mesh.viewer.name + ".glb"), mesh.viewer.glb);
  writeText(folder / "report.html", page);
  Json json = compareJson(request, run, embedded);
  writeJson(folder / "compare.json", json);
  return json;
}

void print(const CompareRequest& request, const CompareRun& run) {
  std::printf("%-30s", "");
  for (const MethodRecord& method : run.methods) std::printf(" %14s", method.name.c_str());
  std::printf("\n");
  for (const NumberGroup& group : numbersOf(run)) {
    for (const NumberRow& row : group.rows) {
      std::printf("%-30s", row.name.c_str());
      for (const std::string& text : row.texts) std::printf(" %14s", text.c_str());
      std::printf("\n");
    }
  }
  std::printf("%s\n", (request.output / "report.html").string().c_str());
}

void run(CompareRequest request) {
  const ThreadLimit threads(request.threads);
  check(request);
  resolve(request.sensor, request.options);
  OutputFolder folder(request.output, request.overwrite ? Existing::Replace : Existing::Refuse);
  TriangleMesh reference = readReference(request.reference);
  const ProgressLine line(request.quiet);
  CompareRun compared = runMethods(request, folder.temporaryPath(), line.progress());
  const MeasuredMeshes measured =
      measureMeshes(request, folder.temporaryPath(), std::move(reference), compared, line.progress());
  const ComparePictures pictures =
      drawPictures(request, folder.temporaryPath(), measured, compared, line.progress());
  JsonReport json(request,
                  writePage(request, folder.temporaryPath(), compared, measured, pictures, line.progress()));
  stopIfInterrupted();
  folder.commit();
  json.commit();
  if (speaks(request)) print(request, compared);
}

void addMethodOptions(CLI::App& app, CompareRequest& request) {
  ReconstructOptions& o = request.options;
  app.option_defaults()->group("Comparison");
  app.add_option("--methods", request.methods,
                 "Columns, in this order; constant: constant ballooning, as strong as --balloon says")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->transform(oneOf({"visibility", "tsdf", "constant"}))
      ->type_name("WORDS")
      ->default_str("visibility,tsdf");
  app.add_option("--balloon", o.evidence.balloon, "Inflation of constant ballooning")
      ->type_name("LOG-ODDS")
      ->capture_default_str();
  addVoxelOptions(app, o);
  app.add_option("--reference", request.reference, "The true surface, or what is taken for it: a mesh")
      ->type_name("FILE")
      ->option_text("none");
  app.add_option("--tau", request.taus, "Distances for precision and completeness, with commas between them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(positiveNumber())
      ->type_name("LENGTH")
      ->option_text("1 % of the reference's diagonal");
}

void addPageOptions(CLI::App& app, CompareRequest& request) {
  app.option_defaults()->group("Page");
  app.add_option("--up", request.up, "Axis that points up in pictures; auto: from the poses")
      ->transform(oneOf({"auto", "x", "y", "z", "-x", "-y", "-z"}))
      ->type_name("WORD")
      ->capture_default_str();
  app.add_option("--slice", request.slice,
                 "Plane of the slices, x|y|z=VALUE; auto: the middle of the surface's shortest side")
      ->type_name("x|y|z=VALUE")
      ->capture_default_str();
  app.add_option("--triangles", request.triangles,
                 "At most so many of each mesh in the page, fewer where it would exceed 20 MB")
      ->check(positiveNumber())
      ->type_name("N")
      ->capture_default_str();
  addColorOption(app, request.color);
}

}  // namespace

void addCompare(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand("compare",
                                      "Set several methods side by side in a page\n\n"
                                      "Writes report.html, one file that loads nothing from anywhere, and "
                                      "all that it shows: meshes, pictures, "
                                      "compare.json.");
  sub.footer(
      "vdbfuse compare scan/ compared/ --reference truth.ply\n"
      "vdbfuse compare scan/ compared/ --methods visibility,tsdf,constant --voxel 0.004");
  auto request = std::make_shared<CompareRequest>();
  constexpr double kBalloon = 0.03;  // fills neither a figure's cavities nor loses its legs at once
  request->options.evidence.balloon = kBalloon;
  sub.add_option("INPUT,--input", request->input, "Data set: a folder or a file")
      ->type_name("PATH")
      ->required();
  sub.add_option("OUTDIR,--output", request->output, "Folder to write")->type_name("FOLDER")->required();
  addMethodOptions(sub, *request);
  addSensorOptions(sub, request->sensor, request->options);
  addPageOptions(sub, *request);
  addJsonOption(sub, request->json, "Write compare.json here as well");
  addMemoryOption(sub, request->options.memory);
  addRunOptions(sub, *request);
  sub.callback([&action, request] { action = [request] { run(*request); }; });
}

}  // namespace vdbfuse::tool
