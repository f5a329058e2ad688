// SPDX-License-Identifier: Apache-2.0
#include "sensor_options.h"

#include <cstdio>

#include "arguments.h"
#include "cli/number_check.h"
#include "cli/one_of.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::tool {
namespace {

const std::vector<std::string> kShapes = {"gaussian", "logistic", "laplace"};
using NoReturn = JudgeOptions::NoReturn;
const std::map<std::string, NoReturn> kNoReturns = {
    {"ignore", NoReturn::Ignore}, {"free", NoReturn::Free}, {"auto", NoReturn::Auto}};

double parseShare(const std::string& text) {
  const double value = parseNumber(text).value_or(-1);
  if (!(value >= 0 && value < 1))
    throw InvalidArgument("--outliers", "expected 'auto' or a share in [0, 1), found '" + text + "'");
  return value;
}

std::vector<std::string> presetNames() {
  std::vector<std::string> names;
  for (const SensorPreset& preset : sensorPresets()) names.push_back(preset.name);
  return names;
}

}  // namespace

std::optional<double> parseNumber(const std::string& text) {
  std::size_t used = 0;
  try {
    const double value = std::stod(text, &used);
    if (used == text.size()) return value;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

std::vector<CLI::Option*> addSensorOptions(CLI::App& app, SensorArguments& arguments,
                                           ReconstructOptions& options) {
  addReadOptions(app, arguments.read);
  app.add_option("--views", arguments.views, "Use the first N views only")
      ->check(positiveNumber())
      ->type_name("N")
      ->option_text("all");
  app.add_option("--bbox", arguments.box, "Domain: the box that the surface is looked for in")
      ->delimiter(',')
      ->expected(6)
      ->type_name("x0,y0,z0,x1,y1,z1")
      ->option_text("where the views agree");
  app.option_defaults()->group("Sensor");
  CLI::Option* sensor =
      app.add_option("--sensor", arguments.sensor, "Noise of a known sensor, poses in metres")
          ->transform(oneOf(presetNames()))
          ->type_name("WORD")
          ->option_text("from the overlap of the views");
  return {
      app.add_option("--noise", arguments.noise, "Shape of the noise of depths")
          ->transform(oneOf(kShapes))
          ->type_name("WORD")
          ->capture_default_str(),
      sensor,
      app.add_option("--noise-scale", options.noise_scale, "Standard deviation at the median depth")
          ->check(positiveNumber())
          ->type_name("LENGTH")
          ->option_text("from the overlap of the views")
          ->excludes(sensor),
      app.add_option("--outliers", arguments.outliers,
                     "Share of wrong depths, the same for every pixel; auto: judged by pixel")
          ->type_name("SHARE")
          ->capture_default_str(),
      app.add_flag("--no-reliability", arguments.no_reliability, "Believe every pixel (as --outliers 0.01)"),
      app.add_flag("--no-denial", arguments.no_denial,
                   "Judge pixels without the second pass, leave-one-out denial"),
      addChoice(app, "--no-return", options.judge.no_return, kNoReturns,
                "What a missing depth around an object means")};
}

void addVoxelOptions(CLI::App& app, ReconstructOptions& options) {
  auto* voxel = app.add_option("--voxel", options.voxel,
                               "Edge of the finest cells; half of it costs four times as much")
                    ->check(positiveNumber())
                    ->type_name("LENGTH")
                    ->option_text("from the data: as fine as the measurements lie, or their noise");
  app.add_option("--resolution", options.resolution,
                 "In place of --voxel: longest side of the domain / voxel")
      ->check(positiveNumber())
      ->type_name("VOXELS")
      ->option_text("from the data, at most 512")
      ->excludes(voxel);
}

void addColorOption(CLI::App& app, std::string& color) {
  app.add_option("--color", color, "auto: from the pictures, where the input has some")
      ->transform(oneOf({"auto", "none"}))
      ->type_name("WORD")
      ->capture_default_str();
}

void resolve(const SensorArguments& arguments, ReconstructOptions& options) {
  constexpr double kBelieveAll = 0.01;
  if (arguments.no_reliability) options.outliers = kBelieveAll;
  if (arguments.outliers != "auto") options.outliers = parseShare(arguments.outliers);
  if (arguments.no_denial) options.judge.denial = JudgeOptions::Denial::Skip;
  options.noise_shape = noiseShape(arguments.noise);
  if (!arguments.sensor.empty()) options.noise = sensorPreset(arguments.sensor).noise;
  options.domain = boxOf(arguments.box);
}

DepthSet readScan(const std::filesystem::path& input, const SensorArguments& arguments, Words words,
                  ReadOptions::Color color) {
  ReadArguments read = arguments.read;
  read.color = color;
  DepthSet set = readInput(input, read);
  if (arguments.views > 0) set.views = set.views.first(arguments.views);
  if (words == Words::Keep) return set;
  for (const std::string& note : set.notes) std::fprintf(stderr, "note: %s\n", note.c_str());
  return set;
}

ViewSequence withPictures(ViewSequence views) {
  return views.load(0).map.color.empty() ? ViewSequence() : views;
}

ViewSequence readPictures(const std::filesystem::path& input, const SensorArguments& arguments) {
  return withPictures(readScan(input, arguments, Words::Keep, ReadOptions::Color::Load).views);
}

}  // namespace vdbfuse::tool
