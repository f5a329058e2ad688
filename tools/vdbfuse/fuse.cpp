// SPDX-License-Identifier: Apache-2.0
// vdbfuse fuse INPUT OUT: depth maps to a surface.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <optional>

#include "commands.h"
#include "fuse_report.h"
#include "json_file.h"
#include "progress_line.h"
#include "read_options.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/io/atomic_file.h"
#include "vdbfuse/io/depth_set.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, Method> kMethods = {{"visibility", Method::Visibility}, {"tsdf", Method::Tsdf}};
const std::map<std::string, EvidenceRule> kRules = {{"outside", EvidenceRule::Outside},
                                                    {"paper", EvidenceRule::Paper},
                                                    {"no-self-occlusion", EvidenceRule::NoSelfOcclusion},
                                                    {"constant", EvidenceRule::Constant}};
const std::vector<std::string> kShapes = {"gaussian", "logistic", "laplace"};
using NoReturn = JudgeOptions::NoReturn;
const std::map<std::string, NoReturn> kNoReturns = {
    {"ignore", NoReturn::Ignore}, {"free", NoReturn::Free}, {"auto", NoReturn::Auto}};

struct Request {
  fs::path input, output, grids, json;
  ReadOptions read;
  ReconstructOptions reconstruct;
  std::vector<double> box;
  std::string border = "auto", outliers = "auto", noise = "gaussian", sensor, thickness = "off";
  std::size_t views = 0;
  int threads = 0;
  bool no_reliability = false, no_denial = false, overwrite = false, quiet = false;
};

template <class T>
CLI::Option* choice(CLI::App& app, const std::string& name, T& target, const std::map<std::string, T>& names,
                    const std::string& help) {
  std::string allowed;
  for (const auto& [word, value] : names) allowed += (allowed.empty() ? "" : "|") + word;
  return app.add_option(name, target, help)
      ->transform(CLI::CheckedTransformer(names, CLI::ignore_case).description(""))
      ->option_text(allowed);
}

void addGridOptions(CLI::App& app, Request& r) {
  auto* voxel =
      app.add_option("--voxel", r.reconstruct.voxel, "Edge of the finest cells, in the unit of the poses")
          ->check(CLI::PositiveNumber);
  app.add_option("--resolution", r.reconstruct.resolution, "Instead: longest side of the domain / voxel")
      ->check(CLI::PositiveNumber)
      ->excludes(voxel);
  app.add_option("--bbox", r.box, "Domain x0,y0,z0,x1,y1,z1; default: where the views agree")
      ->delimiter(',')
      ->expected(6);
  app.add_option("--border", r.border, "What lies beyond the domain")
      ->check(CLI::IsMember({"auto", "outside", "solid", "free"}))
      ->capture_default_str();
}

std::vector<std::string> presetNames() {
  std::vector<std::string> names;
  for (const SensorPreset& preset : sensorPresets()) names.push_back(preset.name);
  return names;
}

void addSensorOptions(CLI::App& app, Request& r) {
  addReadOptions(app, r.read);
  app.add_option("--views", r.views, "Use the first N views only")->check(CLI::PositiveNumber);
  app.add_option("--noise", r.noise, "Shape of the noise of depths")
      ->check(CLI::IsMember(kShapes))
      ->capture_default_str();
  app.add_option("--sensor", r.sensor, "Noise of a known sensor, poses in metres; default: from the overlap")
      ->check(CLI::IsMember(presetNames()));
  app.add_option("--noise-scale", r.reconstruct.noise_scale,
                 "Standard deviation at the median depth; default: from the overlap of the views")
      ->check(CLI::PositiveNumber);
  app.add_option("--outliers", r.outliers,
                 "Share of wrong depths, the same for every pixel; auto: judged by pixel")
      ->capture_default_str();
  app.add_flag("--no-reliability", r.no_reliability, "Believe every pixel (as --outliers 0.01)");
  app.add_flag("--no-denial", r.no_denial, "Judge pixels without the second pass, leave-one-out denial");
  choice(app, "--no-return", r.reconstruct.judge.no_return, kNoReturns,
         "What a missing depth around an object means");
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
                 "Behind a surface, how far solid is to be expected, length; off: any depth alike")
      ->capture_default_str();
  app.add_option("--lambda", o.lambda, "Weight of the evidence, 1/length; default 0.3/voxel")
      ->check(CLI::PositiveNumber);
  app.add_option("--mu", o.mu, "How fast agreement makes a surface cheap")->capture_default_str();
  app.add_option("--truncation", o.truncation, "Of --method tsdf; default 4 voxels")
      ->check(CLI::PositiveNumber);
}

void addOutputOptions(CLI::App& app, Request& r) {
  app.add_option("--save-grids", r.grids,
                 "Also write rho, sigma, support and the signed field as OpenVDB grids");
  app.add_option("--json", r.json, "Write what was done as one JSON object");
  app.add_option("--threads", r.threads, "Number of threads; 0: all processors")
      ->check(CLI::NonNegativeNumber);
  app.add_flag("--overwrite", r.overwrite, "Replace existing output files");
  app.add_flag("--quiet", r.quiet, "Print errors only");
}

void requireNew(const fs::path& path, const Request& request) {
  if (path.empty()) return;
  if (!request.overwrite) refuseExisting(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw IoError(path, "cannot be written: there is no folder " + folder.string());
  const AtomicFile can_be_written(path);  // never committed: leaves nothing
}

std::optional<double> parseNumber(const std::string& text) {
  std::size_t used = 0;
  try {
    const double value = std::stod(text, &used);
    if (used == text.size()) return value;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

double parseShare(const std::string& text) {
  const double value = parseNumber(text).value_or(-1);
  if (!(value >= 0 && value < 1))
    throw InvalidArgument("--outliers", "expected 'auto' or a share in [0, 1), found '" + text + "'");
  return value;
}

double parseThickness(const std::string& text) {
  if (text == "off") return 0;
  const double value = parseNumber(text).value_or(-1);
  if (!(value > 0))
    throw InvalidArgument("--thickness", "expected 'off' or a positive length, found '" + text + "'");
  return value;
}

void resolve(Request& r) {
  ReconstructOptions& o = r.reconstruct;
  if (!r.box.empty()) {
    o.domain =
        Box(Eigen::Vector3d(r.box[0], r.box[1], r.box[2]), Eigen::Vector3d(r.box[3], r.box[4], r.box[5]));
    if (o.domain->isEmpty()) throw InvalidArgument("--bbox", "the lower corner must come first");
  }
  if (r.border != "auto") {
    o.border = r.border == "outside" ? Border::Outside : r.border == "solid" ? Border::Solid : Border::Free;
  }
  constexpr double kBelieveAll = 0.01;
  if (r.no_reliability) o.outliers = kBelieveAll;
  if (r.no_denial) o.judge.denial = JudgeOptions::Denial::Skip;
  if (r.outliers != "auto") o.outliers = parseShare(r.outliers);
  o.noise_shape = noiseShape(r.noise);
  if (!r.sensor.empty()) o.noise = sensorPreset(r.sensor).noise;
  o.thickness = parseThickness(r.thickness);
  if (!r.grids.empty()) o.grids = ReconstructOptions::Grids::Keep;
  r.read.color = ReadOptions::Color::Skip;
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
    outputs.push_back({request.json, [&](const fs::path& path) { writeFuseJson(path, result, context); }});
  }
  outputs.push_back({request.output, [&](const fs::path& path) { writeMesh(path, result.mesh); }});
  writeTogether(outputs);
}

void fuse(Request request) {
  const ThreadLimit threads(request.threads);
  requireMeshFormat(request.output);
  for (const fs::path& path : {request.output, request.grids, request.json}) requireNew(path, request);
  resolve(request);
  DepthSet set = readDepthSet(request.input, request.read);
  if (request.views > 0) set.views = set.views.first(request.views);
  const ProgressLine line(request.quiet);
  if (!request.quiet) {
    for (const std::string& note : set.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  }
  const Reconstruction result = reconstruct(set.views, request.reconstruct, line.progress());
  const FuseContext context{request.input, set.format, set.views.size(), request.reconstruct,
                            topology(result.mesh)};
  writeOutputs(request, result, context);
  if (!request.quiet) printFuseReport(result, context, request.output);
}

}  // namespace

void addFuse(CLI::App& app, Action& action) {
  CLI::App& sub = *app.add_subcommand("fuse", "Turn depth maps with poses into a surface");
  sub.footer("Example: vdbfuse fuse scans/ mesh.ply --voxel 0.002");
  auto request = std::make_shared<Request>();
  sub.add_option("INPUT", request->input, "Folder of depth maps")->required();
  sub.add_option("OUT", request->output, "Mesh to write: .ply, .obj or .stl")->required();
  addGridOptions(sub, *request);
  addSensorOptions(sub, *request);
  addEnergyOptions(sub, *request);
  addOutputOptions(sub, *request);
  sub.callback([&action, request] { action = [request] { fuse(*request); }; });
}

}  // namespace vdbfuse::tool
