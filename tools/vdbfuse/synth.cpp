// SPDX-License-Identifier: Apache-2.0
// vdbfuse synth SCENE OUTDIR: a scan whose truth is known.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "arguments.h"
#include "commands.h"
#include "output_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/version.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/synth/synthetic_scan.h"

namespace vdbfuse::tool {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

const std::map<std::string, Arc> kArcs = {{"full", Arc::Full},
                                          {"ring", Arc::Ring},
                                          {"upper", Arc::Upper},
                                          {"front", Arc::Front},
                                          {"room", Arc::Room}};
const std::map<std::string, SynthNoise> kNoiseLaws = {{"stereo", SynthNoise::Stereo},
                                                      {"structured-light", SynthNoise::StructuredLight},
                                                      {"constant", SynthNoise::Constant}};
const std::map<std::string, ConfidenceKind> kConfidences = {{"informative", ConfidenceKind::Informative},
                                                            {"overlapping", ConfidenceKind::Overlapping},
                                                            {"none", ConfidenceKind::None}};
const std::map<std::string, Background> kBackgrounds = {{"none", Background::None},
                                                        {"wall", Background::Wall}};
struct Request {
  std::string scene;
  fs::path folder;
  std::string size = "640x480", up = "z";
  SynthOptions options;
  std::optional<double> outliers;
  std::optional<ConfidenceKind> confidence;
  PhotographOptions photographs;
  bool textured = false, images_only = false, true_depth = false;
  bool hard = false, oracle = false, overwrite = false, quiet = false;
  int threads = 0;
};

template <class T>
std::string nameOf(const std::map<std::string, T>& names, const T& value) {
  return std::find_if(names.begin(), names.end(), [&](const auto& n) { return n.second == value; })->first;
}

SynthOptions resolved(const Request& request) {
  SynthOptions options = request.hard ? hardened(request.options) : request.options;
  std::tie(options.width, options.height) = parseSize(request.size);
  if (request.outliers) options.outliers = *request.outliers;
  if (request.textured) options.photographs = request.photographs;
  if (request.confidence) options.confidence = *request.confidence;
  refuse("synth", validate(options));
  return options;
}

Scene loadScene(const Request& request) {
  const std::vector<std::string> names = sceneNames();
  const bool known = std::find(names.begin(), names.end(), request.scene) != names.end();
  if (!known && !fs::exists(request.scene))
    throw InvalidArgument(
        "SCENE",
        "'" + request.scene + "' is neither sphere, box, torus, figure, occluder, ball nor a mesh file");
  Scene scene = known ? makeScene(request.scene)
                      : sceneFromMesh(fs::path(request.scene).stem().string(), readMesh(request.scene));
  scene.up = axisNamed(request.up);
  scene.front = frontFor(scene.up);
  return scene;
}

ordered_json json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

ordered_json json(const SceneRegion& region) {
  ordered_json j = {{"name", region.name},
                    {"expect", region.expect == RegionSide::Inside ? "inside" : "outside"}};
  if (const auto* box = std::get_if<Box>(&region.shape)) {
    j.update({{"shape", "box"}, {"min", json(box->min())}, {"max", json(box->max())}});
  } else if (const auto* c = std::get_if<CylinderShape>(&region.shape)) {
    j.update({{"shape", "cylinder"}, {"from", json(c->from)}, {"to", json(c->to)}, {"radius", c->radius}});
  } else if (const auto* s = std::get_if<SphereShape>(&region.shape)) {
    j.update({{"shape", "sphere"}, {"center", json(s->center)}, {"radius", s->radius}});
  }
  return j;
}

ordered_json json(const std::optional<PhotographOptions>& p) {
  if (!p) return {};
  return {{"gain", p->gain}, {"bias", p->bias}, {"noise", p->noise}, {"gloss", p->gloss}};
}

ordered_json json(const SynthOptions& o) {
  return {{"views", o.views},
          {"arc", nameOf(kArcs, o.arc)},
          {"width", o.width},
          {"height", o.height},
          {"noise_law", nameOf(kNoiseLaws, o.noise_law)},
          {"noise_scale", noiseScale(o)},
          {"noise_px", o.noise_px ? ordered_json(*o.noise_px) : ordered_json()},
          {"baseline", o.baseline},
          {"outliers", o.outliers},
          {"hard", o.hard},
          {"missing", o.missing},
          {"confidence", nameOf(kConfidences, o.confidence)},
          {"background", nameOf(kBackgrounds, o.background)},
          {"photographs", json(o.photographs)},
          {"quantum", o.quantum},
          {"seed", o.seed}};
}

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

ordered_json json(const ScanStatistics& s) {
  return {{"object_pixel_share", share(s.object_pixels, s.pixels)},
          {"object_measured_share", share(s.object_measured, s.object_pixels)},
          {"object_wrong_share", share(s.object_wrong, s.object_measured)},
          {"background_measured", s.background_measured},
          {"background_wrong", s.background_wrong}};
}

ordered_json describe(const SyntheticScan& scan, const ScanStatistics& statistics) {
  const SynthOptions& options = scan.options();
  const Box bounds = boundingBox(scan.scene().truth);
  const DepthRange range = depthRange(options);
  ordered_json regions = ordered_json::array();
  for (const SceneRegion& r : scan.scene().regions) regions.push_back(json(r));
  return {{"version", VDBFUSE_VERSION},
          {"scene", scan.scene().name},
          {"up", json(scan.scene().up)},
          {"front", json(scan.scene().front)},
          {"options", json(options)},
          {"focal_length_px", focalLength(options)},
          {"depth_range", {range.near, range.far}},
          {"bounds", {{"min", json(bounds.min())}, {"max", json(bounds.max())}}},
          {"statistics", json(statistics)},
          {"regions", regions}};
}

// The lines `vdbfuse evaluate --regions` reads are part of it.
void writeText(const fs::path& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw IoError(path, "cannot be written");
}

void writeView(MvsnetWriter& writer, const SyntheticView& view, const fs::path& folder,
               const Request& request) {
  const std::string& name = view.view.name;
  if (request.oracle) writePng(folder / "wrong" / (name + ".png"), view.mistake);
  if (request.true_depth) writePfm(folder / "true_depth" / (name + ".pfm"), view.true_depth);
  if (!request.images_only) writer.add(view.view);
}

// Renders a few views at a time, so that all threads have work and the memory stays small.
ScanStatistics writeViews(const SyntheticScan& scan, const fs::path& folder, const Request& request) {
  constexpr std::size_t kBatch = 8;
  if (request.oracle) fs::create_directories(folder / "wrong");
  if (request.true_depth) fs::create_directories(folder / "true_depth");
  MvsnetWriter writer(folder);
  ScanStatistics statistics_sum;
  for (std::size_t first = 0; first < scan.size(); first += kBatch) {
    std::vector<SyntheticView> views(std::min(kBatch, scan.size() - first));
    parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) views[i] = scan.render(first + i);
    });
    for (std::size_t i = 0; i < views.size(); ++i) {
      writeView(writer, views[i], folder, request);
      const Image<Rgb8>& color = views[i].view.map.color;
      if (request.images_only)
        writer.add(Photograph{scan.photographHeader(first + i), brightnessOf(color), color, {}});
      statistics_sum += statistics(views[i]);
    }
  }
  return statistics_sum;
}

void run(const Request& request) {
  const ThreadLimit limit(request.threads);
  const SynthOptions& options = request.options;
  OutputFolder output(request.folder, request.overwrite ? Existing::Replace : Existing::Refuse);
  const SyntheticScan scan(loadScene(request), options);
  const ScanStatistics sum = writeViews(scan, output.temporaryPath(), request);
  writeMesh(output.temporaryPath() / "truth.ply", scan.scene().truth);
  writeText(output.temporaryPath() / "scene.json", describe(scan, sum).dump(2) + "\n");
  output.commit();
  if (request.quiet) return;
  std::printf("%s: %zu views %dx%d of %s, %.1f %% of the object's pixels wrong\n", request.folder.c_str(),
              scan.size(), options.width, options.height, scan.scene().name.c_str(),
              100 * share(sum.object_wrong, sum.object_measured));
}

std::string choices(const auto& names) {
  std::string all;
  for (const auto& entry : names) all += (all.empty() ? "" : "|") + entry.first;
  return all;
}

// An option whose value is one of the names.
CLI::Option* addChoice(CLI::App& app, const std::string& name, auto& target, const auto& names,
                       const std::string& help) {
  const auto choose = [&target, &names](const std::string& text) {
    const auto found = names.find(text);
    if (found == names.end())
      throw CLI::ValidationError("expected " + choices(names) + ", found '" + text + "'");
    target = found->second;
  };
  return app.add_option_function<std::string>(name, choose, help)->type_name(choices(names));
}

void addSensorOptions(CLI::App& app, Request& request) {
  SynthOptions& o = request.options;
  addChoice(app, "--noise-law", o.noise_law, kNoiseLaws, "how noise grows with depth")->default_str("stereo");
  auto* scale =
      app.add_option("--noise-scale", o.noise_scale, "standard deviation of the noise at depth 1, 0: exact")
          ->capture_default_str();
  app.add_option("--noise-px", o.noise_px, "the same as a matching error in pixels")->excludes(scale);
  app.add_option("--baseline", o.baseline, "of the stereo pair that --noise-px speaks of")
      ->capture_default_str();
  app.add_option("--outliers", request.outliers, "share of pixels with a random depth (0; 0.08 with --hard)");
  app.add_flag("--hard", request.hard,
               "mixed silhouettes, whole patches at a wrong depth, overlapping confidences, outliers");
  app.add_option("--missing", o.missing, "share of pixels without a depth")->capture_default_str();
  addChoice(app, "--confidence", request.confidence, kConfidences,
            "what confidences know of wrong pixels (informative; overlapping with --hard)");
  app.add_option("--quantum", o.quantum, "step of the depths; 0: any depth")->capture_default_str();
  app.add_option("--focal", o.focal_px, "focal length, pixels (default: the scene fills the image)");
  addChoice(app, "--background", o.background, kBackgrounds, "what lies behind the object")
      ->default_str("none");
}

void addPhotographOptions(CLI::App& app, Request& request) {
  PhotographOptions& p = request.photographs;
  auto* textured = app.add_flag("--textured", request.textured,
                                "texture and light the scene, and write a picture of each view (images/)");
  app.add_option("--gain", p.gain, "exposures differ by view, by a factor between 1/X and X")
      ->needs(textured)
      ->capture_default_str();
  app.add_option("--bias", p.bias, "of a view's brightness: ±X grey levels")
      ->needs(textured)
      ->capture_default_str();
  app.add_option("--image-noise", p.noise, "standard deviation in the pictures, grey levels")
      ->needs(textured)
      ->capture_default_str();
  app.add_option("--gloss", p.gloss, "brightness of highlights, 0 to 1")
      ->needs(textured)
      ->capture_default_str();
  app.add_flag("--images-only", request.images_only, "cameras and pictures, no depth maps")->needs(textured);
}

}  // namespace

void addSynth(CLI::App& app, Action& action) {
  auto request = std::make_shared<Request>();
  CLI::App* command = app.add_subcommand(
      "synth",
      "Makes a scan whose truth is known: depth maps (MVSNet layout), truth.ply, scene.json.\n"
      "  vdbfuse synth figure scan --arc ring --views 72 --size 320x240 --outliers 0.1");
  command
      ->add_option("scene", request->scene,
                   "sphere, box, torus, figure, occluder, ball, or a closed mesh file")
      ->required();
  command->add_option("outdir", request->folder, "folder to write")->required();
  // The first option: those after it overrule the preset.
  command
      ->add_option_function<std::string>(
          "--preset", [request](const std::string&) { request->options = kinectOptions(); },
          "kinect: 24 views from above, focal length 525, structured-light noise, depths in millimetres; for "
          "the scene ball")
      ->check(CLI::IsMember({"kinect"}));
  SynthOptions& o = request->options;
  command->add_option("--views", o.views, "number of cameras")->capture_default_str();
  addChoice(*command, "--arc", o.arc, kArcs, "where they stand")->default_str("full");
  command->add_option("--size", request->size, "of each depth map, pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--up", request->up, "axis of the scene that points up")
      ->check(axisCheck())
      ->capture_default_str();
  addSensorOptions(*command, *request);
  addPhotographOptions(*command, *request);
  command->add_option("--seed", o.seed, "of the random numbers")->capture_default_str();
  command->add_flag("--oracle", request->oracle,
                    "also write wrong/*.png: 0 right, 1 mixed, 2 patch, 3 outlier");
  command->add_flag("--true-depth", request->true_depth, "also write true_depth/*.pfm: 0 nothing to see");
  command->add_option("--threads", request->threads, "0: all processors")->capture_default_str();
  command->add_flag("--overwrite", request->overwrite, "replace a folder that is not empty");
  command->add_flag("--quiet", request->quiet, "print nothing");
  command->callback([request, &action] {
    request->options = resolved(*request);
    action = [request] { run(*request); };
  });
}

}  // namespace vdbfuse::tool
