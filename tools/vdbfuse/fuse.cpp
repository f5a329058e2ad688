// SPDX-License-Identifier: Apache-2.0
// vdbfuse fuse INPUT OUT: depth maps, or photographs, to a surface.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "arguments.h"
#include "choice.h"
#include "commands.h"
#include "fuse_photographs.h"
#include "fuse_report.h"
#include "json_file.h"
#include "memory_option.h"
#include "progress_line.h"
#include "sensor_options.h"
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

const std::map<std::string, Method> kMethods = {{"visibility", Method::Visibility}, {"tsdf", Method::Tsdf}};
const std::map<std::string, EvidenceRule> kRules = {{"outside", EvidenceRule::Outside},
                                                    {"paper", EvidenceRule::Paper},
                                                    {"no-self-occlusion", EvidenceRule::NoSelfOcclusion},
                                                    {"constant", EvidenceRule::Constant}};

const std::map<std::string, CompletionOptions::Kind> kCompletions = {
    {"isotropic", CompletionOptions::Kind::Isotropic}, {"none", CompletionOptions::Kind::None}};

struct Request {
  fs::path input, output, judgement, grids, json, volume;
  SensorArguments sensor;
  PhotographArguments photographs;
  ReconstructOptions reconstruct;
  std::string border = "auto", thickness = "auto", color = "auto", truncation = "auto";
  std::vector<std::string> weights;
  bool carve = false;
  int threads = 0;
  bool overwrite = false, quiet = false;
};

void addGridOptions(CLI::App& app, Request& r) {
  auto* voxel =
      app.add_option("--voxel", r.reconstruct.voxel, "Edge of the finest cells, in the unit of the poses")
          ->check(CLI::PositiveNumber);
  app.add_option("--resolution", r.reconstruct.resolution, "Instead: longest side of the domain / voxel")
      ->check(CLI::PositiveNumber)
      ->excludes(voxel);
  app.add_option("--border", r.border, "What lies beyond the domain")
      ->check(CLI::IsMember({"auto", "outside", "solid", "free"}))
      ->capture_default_str();
}

void addEnergyOptions(CLI::App& app, Request& r) {
  ReconstructOptions& o = r.reconstruct;
  choice(app, "--method", o.method, kMethods, "Global cut, or Curless-Levoy");
  choice(app, "--rule", o.evidence.rule, kRules, "How the views' testimony is combined");
  app.add_option("--visibility-prior", o.evidence.visibility_prior, "a of the prior Beta(v; a, 1)")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--visibility", o.evidence.visibility, "One visibility v in place of the prior")
      ->check(CLI::Range(0.0, 1.0));
  app.add_option("--prior", o.evidence.prior, "Largest prior log-odds of outside")->capture_default_str();
  app.add_option("--balloon", o.evidence.balloon, "Inflation of --rule constant, log-odds")
      ->capture_default_str();
  app.add_option("--thickness", r.thickness,
                 "How far behind a measured surface solid is to be expected, length; auto: 0.11 "
                 "of the domain's diagonal; off: any distance alike")
      ->capture_default_str();
  app.add_option("--depth-prior", o.prior_decay,
                 "Decay length of the prior of the depth behind which a point is hidden; default: flat")
      ->check(CLI::PositiveNumber);
  app.add_option("--lambda", o.lambda, "Weight of the evidence, 1/length; default 0.6/voxel")
      ->check(CLI::PositiveNumber);
  app.add_option("--mask-error", o.evidence.mask_error, "Share of the pixels of masks that are wrong")
      ->check(CLI::Range(1e-6, 0.499))
      ->capture_default_str();
  app.add_option("--mu", o.mu, "How fast agreement makes a surface cheap")->capture_default_str();
  app.add_option("--trim", o.trim, "Cut away what fewer views than this agree on (0.3: what was invented)")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--min-component", o.min_component,
                 "Drop components with a bounding box of a smaller diagonal, length; default: keep all")
      ->check(CLI::PositiveNumber);
  app.add_option("--simplify", o.simplify, "Leave about so many triangles; flat parts get fewer")
      ->check(CLI::PositiveNumber);
  app.add_option("--color", r.color, "auto: from the pictures, where the input has some")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str();
  choice(app, "--completion", o.completion.kind, kCompletions,
         "Where nothing was measured: a minimal surface, or the faces of the cut");
}

void addTsdfOptions(CLI::App& app, Request& r) {
  TsdfMethod& t = r.reconstruct.tsdf;
  app.add_option("--truncation", r.truncation,
                 "Of --method tsdf: auto: 4 voxels, or 3 x the noise; outliers: what stands for their share; "
                 "or a length")
      ->capture_default_str();
  app.add_option("--continue", r.volume,
                 "Of --method tsdf: a volume that --save-grids wrote, to take more views in")
      ->check(CLI::ExistingFile)
      ->excludes("--voxel")
      ->excludes("--resolution")
      ->excludes("--truncation");
  app.add_flag("--carve", r.carve,
               "Of --method tsdf: space before a measurement is outside, whatever others measured there");
  app.add_option("--weights", r.weights,
                 "Of --method tsdf, what pixels are weighted by: some of "
                 "confidence,noise,incidence,silhouette, or none")
      ->delimiter(',')
      ->check(CLI::IsMember({"confidence", "noise", "incidence", "silhouette", "none"}));
  app.add_option("--min-weight", t.least_weight,
                 "Of --method tsdf: voxels with this weight or less are unknown")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--close-gaps", t.close_gaps, "Of --method tsdf: voxels that holes and rims are filled by")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--trim-rim", t.trim_rim,
                 "Of --method tsdf: cut off frays narrower than twice so many triangles")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void addOutputOptions(CLI::App& app, Request& r) {
  app.add_option("--save-grids", r.grids,
                 "Also write rho, sigma, support and the signed field as OpenVDB grids");
  app.add_option("--json", r.json, "Write what was done as one JSON object");
  addMemoryOption(app, r.reconstruct.memory);
  app.add_option("--threads", r.threads, "Number of threads; 0: all processors")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--overwrite", r.overwrite, "Replace existing output files");
  app.add_flag("--quiet", r.quiet, "Print errors only");
}

std::optional<double> parseThickness(const std::string& text) {
  if (text == "auto") return std::nullopt;
  if (text == "off") return 0;
  const double value = parseNumber(text).value_or(-1);
  if (!(value > 0))
    throw InvalidArgument("--thickness", "expected 'auto', 'off' or a positive length, found '" + text + "'");
  return value;
}

void resolveTsdf(const Request& r, TsdfMethod& tsdf) {
  if (r.truncation == "outliers") {
    tsdf.otherwise = TsdfMethod::Truncation::FromOutliers;
  } else if (r.truncation != "auto") {
    tsdf.truncation = parseNumber(r.truncation).value_or(-1);
    if (!(tsdf.truncation > 0))
      throw InvalidArgument("--truncation",
                            "expected 'auto', 'outliers' or a positive length, found '" + r.truncation + "'");
  }
  if (!r.volume.empty()) tsdf.start = std::make_shared<TsdfVolume>(TsdfVolume::read(r.volume));
  if (r.carve) tsdf.carving = TsdfMethod::Carving::On;
  if (r.weights.empty()) return;
  const auto has = [&](const char* name) {
    return std::find(r.weights.begin(), r.weights.end(), name) != r.weights.end();
  };
  tsdf.weights = {has("confidence"), has("noise"), has("incidence"), has("silhouette")};
}

void requireNew(const fs::path& path, const Request& request) {
  if (path.empty()) return;
  if (!request.overwrite) refuseExisting(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw IoError(path, "cannot be written: there is no folder " + folder.string());
  const AtomicFile can_be_written(path);  // never committed: leaves nothing
}

void resolve(Request& r) {
  ReconstructOptions& o = r.reconstruct;
  resolve(r.sensor, o);
  if (r.border != "auto") {
    o.border = r.border == "outside" ? Border::Outside : r.border == "solid" ? Border::Solid : Border::Free;
  }
  o.thickness = parseThickness(r.thickness);
  resolveTsdf(r, o.tsdf);
  if (o.tsdf.start) o.voxel = o.tsdf.start->frame().voxel, o.method = Method::Tsdf;
  if (!r.grids.empty()) o.grids = ReconstructOptions::Grids::Keep;
}

void writeOutputs(const Request& request, const Reconstruction& result, const FuseContext& context) {
  std::vector<Output> outputs;
  if (!request.grids.empty()) {
    outputs.push_back({request.grids, [&](const fs::path& path) {
                         std::vector<const ScalarGrid*> grids;
                         for (const ScalarGrid& grid : result.grids) grids.push_back(&grid);
                         writeGrids(path, grids);
                       }});
  }
  if (!request.json.empty()) {
    outputs.push_back(
        {request.json, [&](const fs::path& path) { writeJson(path, fuseJson(result, context)); }});
  }
  outputs.push_back({request.output, [&](const fs::path& path) { writeMesh(path, result.mesh); }});
  writeTogether(outputs);
}

JudgedScan judged(const DepthSet& set, Request& request, const Progress& progress) {
  ScanPlan plan = planReconstruction(set.views, request.reconstruct, progress);
  if (!request.quiet) printPlan(plan, request.reconstruct.method);
  if (request.judgement.empty()) return judgeScan(set.views, request.reconstruct, std::move(plan), progress);
  JudgedScan scan = readJudgement(request.judgement, set.views, std::move(plan), progress);
  request.reconstruct.noise_shape = scan.judgement.judged.sensor.shape;
  return scan;
}

// Looks at one view: data sets have pictures for all of them, or for none.
bool hasPictures(const ViewSequence& views) { return !views.load(0).map.color.empty(); }

Words wordsOf(const Request& request) { return request.quiet ? Words::Keep : Words::Print; }

// What is fused. Depth maps are read without their pictures, which colour the mesh at the end.
struct Input {
  DepthSet set;
  std::optional<StereoSummary> stereo;  ///< of photographs
};

Input readInput(Request& request, const Progress& progress) {
  if (!takesPhotographs(request.input, request.sensor, request.photographs)) {
    Input input{readScan(request.input, request.sensor, wordsOf(request)), std::nullopt};
    if (!request.quiet) warnOf(input.set);
    return input;
  }
  MatchedScan scan = matchPhotographs(request.input, request.sensor, request.photographs, request.reconstruct,
                                      wordsOf(request), progress);
  return {std::move(scan.set), std::move(scan.stereo)};
}

ViewSequence picturesOf(const Request& request, const Input& input) {
  if (input.stereo) return input.set.views;
  return readScan(request.input, request.sensor, Words::Keep, ReadOptions::Color::Load).views;
}

void fuse(Request request) {
  const ThreadLimit threads(request.threads);
  requireMeshFormat(request.output);
  for (const fs::path& path : {request.output, request.grids, request.json}) requireNew(path, request);
  resolve(request);
  const ProgressLine line(request.quiet);
  const Input input = readInput(request, line.progress());
  Reconstruction result =
      reconstruct(judged(input.set, request, line.progress()), request.reconstruct, line.progress());
  if (request.color == "auto") {
    const ViewSequence pictures = picturesOf(request, input);
    if (hasPictures(pictures)) colorReconstruction(pictures, result, line.progress());
  }
  if (input.stereo)
    result.steps.insert(result.steps.begin(), input.stereo->steps.begin(), input.stereo->steps.end());
  const FuseContext context{
      request.input,       request.judgement,     input.set.format, input.set.views.size(),
      request.reconstruct, topology(result.mesh), input.stereo};
  writeOutputs(request, result, context);
  if (!request.quiet) printFuseReport(result, context, request.output);
}

}  // namespace

void addFuse(CLI::App& app, Action& action) {
  CLI::App& sub =
      *app.add_subcommand("fuse", "Turn depth maps with poses, or photographs with cameras, into a surface");
  sub.footer(
      "Example: vdbfuse fuse scans/ mesh.ply --voxel 0.002\n         vdbfuse fuse photographs/ mesh.ply");
  auto request = std::make_shared<Request>();
  sub.add_option("INPUT", request->input, "Data set: a folder or a file")->required();
  sub.add_option("OUT", request->output, "Mesh to write: .ply, .obj, .stl or .glb")->required();
  addGridOptions(sub, *request);
  const std::vector<CLI::Option*> judged_before =
      addSensorOptions(sub, request->sensor, request->reconstruct);
  CLI::Option* judgement = sub.add_option("--judgement", request->judgement,
                                          "Folder written by vdbfuse judge: use it instead of judging again");
  for (CLI::Option* option : judged_before) judgement->excludes(option);
  addEnergyOptions(sub, *request);
  addTsdfOptions(sub, *request);
  addPhotographOptions(sub, request->photographs);
  addOutputOptions(sub, *request);
  sub.callback([&action, request] {
    refuse("options", validate(request->photographs.stereo));
    action = [request] { fuse(*request); };
  });
}

}  // namespace vdbfuse::tool
