// SPDX-License-Identifier: Apache-2.0
#include "fuse_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <memory>

#include "arguments.h"
#include "cli/number_check.h"
#include "cli/one_of.h"
#include "memory_option.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::tool {
namespace {

const std::map<std::string, Method> kMethods = {{"visibility", Method::Visibility}, {"tsdf", Method::Tsdf}};
const std::map<std::string, EvidenceRule> kRules = {{"outside", EvidenceRule::Outside},
                                                    {"paper", EvidenceRule::Paper},
                                                    {"no-self-occlusion", EvidenceRule::NoSelfOcclusion},
                                                    {"constant", EvidenceRule::Constant}};

const std::map<std::string, CompletionOptions::Kind> kCompletions = {
    {"isotropic", CompletionOptions::Kind::Isotropic}, {"none", CompletionOptions::Kind::None}};

void addGridOptions(CLI::App& app, FuseRequest& r) {
  app.option_defaults()->group("Grid");
  addVoxelOptions(app, r.reconstruct);
  app.add_option("--border", r.border,
                 "What lies beyond the domain; auto: solid when most sensors are inside it, else outside")
      ->transform(oneOf({"auto", "outside", "solid", "free"}))
      ->type_name("WORD")
      ->capture_default_str();
}

void addEnergyOptions(CLI::App& app, FuseRequest& r) {
  ReconstructOptions& o = r.reconstruct;
  app.option_defaults()->group("Energy");
  addChoice(app, "--method", o.method, kMethods,
            "Global minimum cut, or signed distances (Curless and Levoy)");
  addChoice(app, "--rule", o.evidence.rule, kRules, "How the views' testimony is combined");
  app.add_option("--visibility-prior", o.visibility_prior,
                 "a of the prior Beta(v; a, 1); smaller: outside may be seen by fewer views")
      ->check(positiveNumber())
      ->type_name("NUMBER")
      ->option_text("1 for 8 views or fewer, 0.5 for 24 or more");
  app.add_option("--visibility", o.evidence.visibility, "One visibility v in place of the prior")
      ->check(numberBetween(0.0, 1.0))
      ->type_name("SHARE")
      ->option_text("none: the prior");
  app.add_option("--prior", o.evidence.prior, "Largest prior log-odds of outside")
      ->type_name("LOG-ODDS")
      ->capture_default_str();
  app.add_option("--balloon", o.evidence.balloon, "Inflation of --rule constant")
      ->type_name("LOG-ODDS")
      ->capture_default_str();
  app.add_option(
         "--thickness", r.thickness,
         "How far behind a measured surface solid is to be expected; auto: 0.11 of the domain's diagonal; "
         "off: any distance alike")
      ->type_name("LENGTH")
      ->capture_default_str();
  app.add_option("--depth-prior", o.prior_decay,
                 "Decay length of the prior of the depth behind which a point is hidden")
      ->check(positiveNumber())
      ->type_name("LENGTH")
      ->option_text("none: flat");
  app.add_option("--lambda", o.lambda, "Weight of the evidence")
      ->check(positiveNumber())
      ->type_name("1/LENGTH")
      ->option_text("0.6/max(voxel, noise)");
  app.add_option("--mask-error", o.evidence.mask_error, "Share of the pixels of masks that are wrong")
      ->check(numberBetween(1e-6, 0.499))
      ->type_name("SHARE")
      ->capture_default_str();
  app.add_option("--least-cost", o.least_cost,
                 "Cost of a surface however many views agree; larger: fewer folds within the noise")
      ->check(numberBetween(0, 1))
      ->type_name("NUMBER")
      ->option_text("0.4 x noise/max(voxel, noise); 0 unless --rule outside");
  app.add_option("--mu", o.mu,
                 "How fast agreement makes a surface cheap: e^(-mu x agreeing views), at least --least-cost")
      ->type_name("NUMBER")
      ->capture_default_str();
}

void addSurfaceOptions(CLI::App& app, FuseRequest& r) {
  ReconstructOptions& o = r.reconstruct;
  app.option_defaults()->group("Surface");
  app.add_option("--trim", o.trim, "Cut away what fewer views than this agree on; 0.3: what was invented")
      ->check(nonNegativeNumber())
      ->type_name("NUMBER")
      ->capture_default_str();
  app.add_option("--min-component", o.min_component,
                 "Drop components whose bounding box has a smaller diagonal; 0: keep all")
      ->check(nonNegativeNumber())
      ->type_name("LENGTH")
      ->capture_default_str();
  app.add_option("--simplify", o.simplify, "Leave about so many triangles; flat parts get fewer; 0: keep all")
      ->check(nonNegativeNumber())
      ->type_name("N")
      ->capture_default_str();
  addColorOption(app, r.color);
  addChoice(app, "--completion", o.completion.kind, kCompletions,
            "Where nothing was measured: a minimal surface, or the faces of the cut");
}

void addTsdfOptions(CLI::App& app, FuseRequest& r) {
  TsdfMethod& t = r.reconstruct.tsdf;
  app.option_defaults()->group("Of --method tsdf");
  app.add_option(
         "--truncation", r.truncation,
         "Where distances end; auto: the larger of 4 voxels and 3 x the noise; outliers: what stands for "
         "their share")
      ->type_name("LENGTH")
      ->capture_default_str();
  app.add_option("--continue", r.volume, "A volume that --save-grids wrote, to take more views in")
      ->check(CLI::ExistingFile)
      ->type_name("FILE")
      ->option_text("none: a new volume")
      ->excludes("--voxel")
      ->excludes("--resolution")
      ->excludes("--truncation");
  app.add_flag("--carve", r.carve, "Space before a measurement is outside, whatever others measured there");
  app.add_option("--weights", r.weights, "What pixels are weighted by, or none")
      ->delimiter(',')
      ->transform(oneOf({"confidence", "noise", "incidence", "silhouette", "none"}))
      ->type_name("WORDS")
      ->default_str(joined(weightNames(t.weights), ","));
  app.add_option("--min-weight", t.least_weight, "Voxels with this weight or less are unknown")
      ->check(nonNegativeNumber())
      ->type_name("NUMBER")
      ->capture_default_str();
  app.add_option("--close-gaps", t.close_gaps, "Voxels that holes and rims are filled by")
      ->check(nonNegativeNumber())
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--trim-rim", t.trim_rim, "Cut off frays narrower than twice so many triangles")
      ->check(nonNegativeNumber())
      ->type_name("N")
      ->capture_default_str();
}

void addOutputOptions(CLI::App& app, FuseRequest& r) {
  app.option_defaults()->group("Output");
  app.add_option("--save-grids", r.grids,
                 "Also write rho, sigma, support and the signed field as OpenVDB grids")
      ->type_name("FILE")
      ->option_text("none");
}

void addRunGroup(CLI::App& app, CLI::Option& out, FuseRequest& r) {
  app.option_defaults()->group(kRunGroup);
  app.add_flag_callback(
      "--explain", [&r, &out] { r.explain = true, out.required(false); },
      "Read and judge the input, print every parameter with its value and why, and stop there; OUT is not "
      "needed");
  addJsonOption(app, r.json, "Write what was done as one JSON object");
  addMemoryOption(app, r.reconstruct.memory);
  addRunOptions(app, r);
}

std::optional<double> parseThickness(const std::string& text) {
  if (text == "auto") return std::nullopt;
  if (text == "off") return 0;
  const double value = parseNumber(text).value_or(-1);
  if (!(value > 0))
    throw InvalidArgument("--thickness", "expected 'auto', 'off' or a positive length, found '" + text + "'");
  return value;
}

void resolveTsdf(const FuseRequest& r, TsdfMethod& tsdf) {
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

}  // namespace

std::vector<std::string> weightNames(const WeightOptions& weights) {
  std::vector<std::string> names;
  if (weights.confidence) names.emplace_back("confidence");
  if (weights.noise) names.emplace_back("noise");
  if (weights.incidence) names.emplace_back("incidence");
  if (weights.silhouette) names.emplace_back("silhouette");
  if (names.empty()) names.emplace_back("none");
  return names;
}

void resolve(FuseRequest& r) {
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

void addFuseOptions(CLI::App& app, FuseRequest& request) {
  app.add_option("INPUT,--input", request.input, "Data set: depth maps, or photographs with cameras")
      ->type_name("PATH")
      ->required();
  CLI::Option* out = app.add_option("OUT,--output", request.output, "Mesh to write: .ply, .obj, .stl or .glb")
                         ->type_name("FILE")
                         ->required();
  addGridOptions(app, request);
  const std::vector<CLI::Option*> judged_before = addSensorOptions(app, request.sensor, request.reconstruct);
  CLI::Option* judgement = app.add_option("--judgement", request.judgement,
                                          "Folder written by vdbfuse judge: use it instead of judging again")
                               ->type_name("FOLDER")
                               ->option_text("none: judge");
  for (CLI::Option* option : judged_before) judgement->excludes(option);
  addEnergyOptions(app, request);
  addSurfaceOptions(app, request);
  addTsdfOptions(app, request);
  addPhotographOptions(app, request.photographs);
  addOutputOptions(app, request);
  addRunGroup(app, *out, request);
}

}  // namespace vdbfuse::tool
