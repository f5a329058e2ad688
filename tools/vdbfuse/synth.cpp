// SPDX-License-Identifier: Apache-2.0
// vdbfuse synth SCENE OUTDIR: a scan whose truth is known.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "arguments.h"
#include "cli/nearest.h"
#include "cli/one_of.h"
#include "commands.h"
#include "interrupts.h"
#include "output_folder.h"
#include "progress_line.h"
#include "run_options.h"
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
struct Request : RunArguments {
  std::string scene;
  fs::path folder;
  std::string size = "640x480", up = "z";
  SynthOptions options;
  std::optional<double> outliers;
  std::optional<ConfidenceKind> confidence;
  PhotographOptions photographs;
  bool textured = false, images_only = false, true_depth = false;
  bool hard = false, oracle = false;
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
    throw InvalidArgument("SCENE",
                          "'" + request.scene +
                              "' is neither sphere, box, torus, figure, occluder, ball nor a mesh file" +
                              didYouMean(request.scene, names));
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
ScanStatistics writeViews(const SyntheticScan& scan, const fs::path& folder, const Request& request,
                          const Progress& progress) {
  constexpr std::size_t kBatch = 8;
  if (request.oracle) fs::create_directories(folder / "wrong");
  if (request.true_depth) fs::create_directories(folder / "true_depth");
  MvsnetWriter writer(folder);
  ScanStatistics statistics_sum;
  ProgressStep step(progress, "views", scan.size());
  for (std::size_t first = 0; first < scan.size(); first += kBatch) {
    std::vector<SyntheticView> views(std::min(kBatch, scan.size() - first));
    parallelFor(views.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        stopIfInterrupted();
        views[i] = scan.render(first + i);
      }
    });
    for (std::size_t i = 0; i < views.size(); ++i) {
      writeView(writer, views[i], folder, request);
      const Image<Rgb8>& color = views[i].view.map.color;
      if (request.images_only)
        writer.add(Photograph{scan.photographHeader(first + i), brightnessOf(color), color, {}});
      statistics_sum += statistics(views[i]);
      step.advance();
    }
  }
  return statistics_sum;
}

void run(const Request& request) {
  const ThreadLimit limit(request.threads);
  const SynthOptions& options = request.options;
  refuseExistingJson(request);
  OutputFolder output(request.folder, request.overwrite ? Existing::Replace : Existing::Refuse);
  const SyntheticScan scan(loadScene(request), options);
  const ProgressLine line(request.quiet, {{"views", 1}});
  const ScanStatistics sum = writeViews(scan, output.temporaryPath(), request, line.progress());
  writeMesh(output.temporaryPath() / "truth.ply", scan.scene().truth);
  const ordered_json description = describe(scan, sum);
  writeText(output.temporaryPath() / "scene.json", description.dump(2) + "\n");
  JsonReport json(request, description);
  output.commit();
  json.commit();
  if (!speaks(request)) return;
  std::printf("%s: %zu views %dx%d of %s, %.1f %% of the object's pixels wrong\n", request.folder.c_str(),
              scan.size(), options.width, options.height, scan.scene().name.c_str(),
              100 * share(sum.object_wrong, sum.object_measured));
}

void addSensorOptions(CLI::App& app, Request& request) {
  SynthOptions& o = request.options;
  app.option_defaults()->group("Sensor");
  addChoice(app, "--noise-law", o.noise_law, kNoiseLaws, "How noise grows with depth");
  auto* scale =
      app.add_option("--noise-scale", o.noise_scale, "Standard deviation of the noise at depth 1; 0: exact")
          ->type_name("LENGTH")
          ->capture_default_str();
  app.add_option("--noise-px", o.noise_px, "The same as a matching error")
      ->type_name("PIXELS")
      ->option_text("none: --noise-scale")
      ->excludes(scale);
  app.add_option("--baseline", o.baseline, "Of the stereo pair that --noise-px speaks of")
      ->type_name("LENGTH")
      ->capture_default_str();
  app.add_option("--outliers", request.outliers, "Share of pixels with a random depth")
      ->type_name("SHARE")
      ->option_text("0; 0.08 with --hard");
  app.add_flag("--hard", request.hard,
               "Mixed silhouettes, whole patches at a wrong depth, overlapping confidences, outliers");
  app.add_option("--missing", o.missing, "Share of pixels without a depth")
      ->type_name("SHARE")
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--confidence", [&request](const std::string& name) { request.confidence = kConfidences.at(name); },
         "What confidences know of wrong pixels")
      ->transform(oneOf({"informative", "overlapping", "none"}))
      ->type_name("WORD")
      ->option_text("informative; overlapping with --hard");
  app.add_option("--quantum", o.quantum, "Step of the depths; 0: any depth")
      ->type_name("LENGTH")
      ->capture_default_str();
  app.add_option("--focal", o.focal_px, "Focal length")
      ->type_name("PIXELS")
      ->option_text("the scene fills the image");
}

void addPhotographOptions(CLI::App& app, Request& request) {
  PhotographOptions& p = request.photographs;
  app.option_defaults()->group("Photographs");
  auto* textured = app.add_flag("--textured", request.textured,
                                "Texture and light the scene, and write a picture of each view (images/)");
  app.add_option("--gain", p.gain, "Exposures differ by view, by a factor between 1/X and X")
      ->type_name("NUMBER")
      ->needs(textured)
      ->capture_default_str();
  app.add_option("--bias", p.bias, "Of a view's brightness, up or down")
      ->type_name("GREY-LEVELS")
      ->needs(textured)
      ->capture_default_str();
  app.add_option("--image-noise", p.noise, "Standard deviation in the pictures")
      ->type_name("GREY-LEVELS")
      ->needs(textured)
      ->capture_default_str();
  app.add_option("--gloss", p.gloss, "Brightness of highlights")
      ->type_name("SHARE")
      ->needs(textured)
      ->capture_default_str();
  app.add_flag("--images-only", request.images_only, "Cameras and pictures, no depth maps")->needs(textured);
}

std::string text(double value) {
  char number[32];
  std::snprintf(number, sizeof number, "%g", value);
  return number;
}

// What --preset decides where the command line does not.
std::vector<FoundValue> presetValues(const SynthOptions& o) {
  const std::string why = "--preset";
  return {{"views", std::to_string(o.views), why},
          {"arc", nameOf(kArcs, o.arc), why},
          {"noise-law", nameOf(kNoiseLaws, o.noise_law), why},
          {"noise-scale", text(noiseScale(o)), why},
          {"quantum", text(o.quantum), why},
          {"background", nameOf(kBackgrounds, o.background), why},
          {"focal", text(focalLength(o)), why}};
}

// Returns --preset.
CLI::Option* addCameraOptions(CLI::App& app, Request& request) {
  SynthOptions& o = request.options;
  app.option_defaults()->group("Scene and cameras");
  // The first option: those after it overrule the preset.
  CLI::Option* preset =
      app.add_option_function<std::string>(
             "--preset", [&request](const std::string&) { request.options = kinectOptions(); },
             "kinect: 24 views from above, focal length 525, structured-light noise, depths in millimetres; "
             "for "
             "the "
             "scene ball")
          ->transform(oneOf({"kinect"}))
          ->type_name("WORD")
          ->option_text("none");
  app.add_option("--views", o.views, "Number of cameras")->type_name("N")->capture_default_str();
  addChoice(app, "--arc", o.arc, kArcs, "Where they stand");
  app.add_option("--size", request.size, "Of each depth map")->type_name("WxH")->capture_default_str();
  app.add_option("--up", request.up, "Axis of the scene that points up")
      ->transform(axisCheck())
      ->type_name("WORD")
      ->capture_default_str();
  addChoice(app, "--background", o.background, kBackgrounds, "What lies behind the object");
  app.add_option("--seed", o.seed, "Of the random numbers")->type_name("N")->capture_default_str();
  return preset;
}

}  // namespace

void addSynth(CLI::App& app, Action& action) {
  auto request = std::make_shared<Request>();
  CLI::App& sub = *app.add_subcommand(
      "synth",
      "Make a scan whose truth is known\n\n"
      "Depth maps in the layout of MVSNet, truth.ply, and scene.json with the regions that vdbfuse evaluate "
      "looks at. Scenes have a diagonal of 1, cameras stand 1.5 away.");
  sub.footer(
      "vdbfuse synth figure scan/ --arc ring --views 72 --size 320x240 --outliers 0.1\n"
      "vdbfuse synth figure photographs/ --arc ring --views 72 --textured --images-only");
  sub.add_option("SCENE,--scene", request->scene,
                 "sphere, box, torus, figure, occluder, ball, or a closed mesh file")
      ->type_name("NAME")
      ->required();
  sub.add_option("OUTDIR,--output", request->folder, "Folder to write")->type_name("FOLDER")->required();
  const CLI::Option* preset = addCameraOptions(sub, *request);
  addSensorOptions(sub, *request);
  addPhotographOptions(sub, *request);
  sub.option_defaults()->group("Output");
  sub.add_flag("--oracle", request->oracle, "Also write wrong/*.png: 0 right, 1 mixed, 2 patch, 3 outlier");
  sub.add_flag("--true-depth", request->true_depth, "Also write true_depth/*.pfm: 0 nothing to see");
  addJsonOption(sub, request->json, "Write scene.json here as well");
  addRunOptions(sub, *request);
  sub.callback([request, preset, &action] {
    request->options = resolved(*request);
    if (preset->count() > 0) action.found = presetValues(request->options);
    action = [request] { run(*request); };
  });
}

}  // namespace vdbfuse::tool
