// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare INPUT OUTDIR: several methods on one scan, side by side in a page.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "arguments.h"
#include "commands.h"
#include "compare_methods.h"
#include "compare_page.h"
#include "compare_pictures.h"
#include "json_file.h"
#include "memory_option.h"
#include "output_folder.h"
#include "progress_line.h"
#include "render_slice.h"
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
  if (!request.json.empty() && !request.overwrite) refuseExisting(request.json);
  if (request.slice != "auto") parsePlane(request.slice);
  if (!request.taus.empty() && request.reference.empty())
    throw InvalidArgument("--tau", "needs --reference: distances are measured from it");
  methodsOf(request);
}

// The page with meshes as fine as asked for, or as its size allows.
void writePage(const CompareRequest& request, const fs::path& folder, const CompareRun& run,
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
    writeBytes(folder / "viewer" / (mesh.viewer.name + ".glb"), mesh.viewer.glb);
  writeBytes(folder / "report.html", page);
  writeJson(folder / "compare.json", compareJson(request, run, embedded));
  if (!request.json.empty()) writeJson(request.json, compareJson(request, run, embedded));
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
  writePage(request, folder.temporaryPath(), compared, measured, pictures, line.progress());
  folder.commit();
  if (!request.quiet) print(request, compared);
}

void addMethodOptions(CLI::App& app, CompareRequest& request) {
  ReconstructOptions& o = request.options;
  app.add_option("--methods", request.methods,
                 "Some of visibility, tsdf and constant (constant ballooning), in the order of the columns")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"visibility", "tsdf", "constant"}))
      ->capture_default_str();
  app.add_option("--balloon", o.evidence.balloon, "Inflation of constant ballooning, log-odds")
      ->capture_default_str();
  auto* voxel = app.add_option("--voxel", o.voxel, "Edge of the finest cells, in the unit of the poses")
                    ->check(CLI::PositiveNumber);
  app.add_option("--resolution", o.resolution, "Instead: longest side of the domain / voxel")
      ->check(CLI::PositiveNumber)
      ->excludes(voxel);
  app.add_option("--reference", request.reference, "The true surface, or what is taken for it: a mesh");
  app.add_option("--tau", request.taus,
                 "Distances for precision and completeness; default: 1 % of the reference's diagonal")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::PositiveNumber);
}

void addPageOptions(CLI::App& app, CompareRequest& request) {
  app.add_option("--up", request.up, "Axis that points up in pictures; auto: from the poses")
      ->check(CLI::IsMember({"auto", "x", "y", "z", "-x", "-y", "-z"}))
      ->capture_default_str();
  app.add_option("--slice", request.slice,
                 "Plane of the slices, x|y|z=VALUE; auto: the middle of the surface's shortest side")
      ->capture_default_str();
  app.add_option("--triangles", request.triangles,
                 "At most so many of each mesh in the page, fewer where it would exceed 20 MB")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--color", request.color, "auto: from the pictures, where the input has some")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str();
  app.add_option("--json", request.json, "Write compare.json here as well");
  addMemoryOption(app, request.options.memory);
  app.add_option("--threads", request.threads, "Number of threads; 0: all processors")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--overwrite", request.overwrite, "Replace existing outputs");
  app.add_flag("--quiet", request.quiet, "Print errors only");
}

}  // namespace

void addCompare(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand("compare", "Several methods on one scan, side by side in a page");
  sub.footer(
      "Writes report.html, one file that loads nothing, and all that it shows: meshes, pictures,\n"
      "compare.json.\n\n"
      "Example: vdbfuse compare scan/ compared/ --reference truth.ply\n"
      "         vdbfuse compare scan/ compared/ --methods visibility,tsdf,constant --voxel 0.004");
  auto request = std::make_shared<CompareRequest>();
  constexpr double kBalloon = 0.03;  // fills neither a figure's cavities nor loses its legs at once
  request->options.evidence.balloon = kBalloon;
  sub.add_option("INPUT", request->input, "Data set: a folder or a file")->required();
  sub.add_option("OUTDIR", request->output, "Folder to write")->required();
  addMethodOptions(sub, *request);
  addSensorOptions(sub, request->sensor, request->options);
  addPageOptions(sub, *request);
  sub.callback([&action, request] { action = [request] { run(*request); }; });
}

}  // namespace vdbfuse::tool
