// SPDX-License-Identifier: Apache-2.0
#include "read_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/number_check.h"
#include "cli/one_of.h"

namespace vdbfuse::tool {
namespace {

constexpr std::array<std::pair<const char*, DepthKind>, 4> kKinds = {{{"z", DepthKind::Z},
                                                                      {"range", DepthKind::Range},
                                                                      {"disparity", DepthKind::Disparity},
                                                                      {"inverse", DepthKind::Inverse}}};

std::vector<std::string> kindNames() {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kKinds) names.emplace_back(name);
  return names;
}

std::vector<std::string> formatNames() {
  std::vector<std::string> names;
  for (const DepthSetFormat& format : depthSetFormats()) names.emplace_back(format.name);
  for (const ImageSetFormat& format : imageSetFormats()) {
    if (std::find(names.begin(), names.end(), format.name) == names.end()) names.emplace_back(format.name);
  }
  return names;
}

// Whether one of the formats, the one of that name where one is given, fits in full.
bool fitsFully(const auto& formats, const std::filesystem::path& path, const std::string& name) {
  return std::any_of(formats.begin(), formats.end(), [&](const auto& format) {
    return (name.empty() || name == format.name) && format.detect(path).fit == Detection::Fit::Fully;
  });
}

bool isNamed(const auto& formats, const std::string& name) {
  return std::any_of(formats.begin(), formats.end(), [&](const auto& format) { return format.name == name; });
}

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

CLI::Validator conventionCheck() {
  return CLI::Validator(
      [](const std::string& text) {
        const bool known = text == "none" || text == "auto" || conventionNamed(text);
        return known ? std::string() : "unknown convention '" + text + "'";
      },
      "auto|none|LIST");
}

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

// What is asked for; the views may have to be looked at.
std::optional<Convention> wanted(const DepthSet& set, const std::string& name, std::string& why) {
  if (name == "none") return std::nullopt;
  if (name != "auto") return conventionNamed(name);
  const ConventionCheck check = checkConvention(set.views, set.stored_from_camera);
  if (!check.better) return std::nullopt;
  why = "; " + percent(check.better->agreement) + " of the points agree, " + percent(*check.agreement) +
        " as they were read";
  return check.better->convention;
}

}  // namespace

InputKind kindOf(const std::filesystem::path& path, const std::string& format) {
  const bool only_photographs = isNamed(imageSetFormats(), format) && !isNamed(depthSetFormats(), format);
  if (only_photographs) return InputKind::Photographs;
  if (!std::filesystem::exists(path) || fitsFully(depthSetFormats(), path, format))
    return InputKind::DepthMaps;
  return fitsFully(imageSetFormats(), path, format) ? InputKind::Photographs : InputKind::DepthMaps;
}

DepthSet readInput(const std::filesystem::path& path, const ReadArguments& arguments) {
  DepthSet set = readDepthSet(path, arguments);
  std::string why;
  const std::optional<Convention> convention = wanted(set, arguments.fix_convention, why);
  if (!convention) return set;
  set.views = underConvention(set.views, set.stored_from_camera, *convention);
  set.notes.push_back("taken as " + nameOf(*convention) + ": " + describe(*convention) + why);
  return set;
}

void warnOf(const ConventionCheck& check) {
  if (!check.better) return;
  std::fprintf(
      stderr,
      "warning: the views disagree with each other (%.0f %% of the points agree). %.0f %% would, if %s.\n"
      "         Try --fix-convention %s\n",
      100 * *check.agreement, 100 * check.better->agreement, describe(check.better->convention).c_str(),
      nameOf(check.better->convention).c_str());
}

void warnOf(const DepthSet& set) {
  ConventionOptions options;
  options.enough = 0.6;
  warnOf(checkConvention(set.views, set.stored_from_camera, options));
}

Json jsonOf(const ReadArguments& arguments) {
  Json json;
  json["format"] = arguments.format.empty() ? Json(nullptr) : Json(arguments.format);
  json["depth_scale"] = arguments.depth_scale ? Json(*arguments.depth_scale) : Json(nullptr);
  json["depth_kind"] = arguments.depth_kind ? Json(nameOf(*arguments.depth_kind)) : Json(nullptr);
  json["baseline"] = arguments.baseline ? Json(*arguments.baseline) : Json(nullptr);
  json["intrinsics"] = arguments.intrinsics ? Json(*arguments.intrinsics) : Json(nullptr);
  json["splat_step_deg"] =
      arguments.splat_step ? Json(*arguments.splat_step / kRadiansPerDegree) : Json(nullptr);
  json["masks"] = arguments.masks.empty() ? Json(nullptr) : Json(arguments.masks.string());
  json["min_depth"] = arguments.min_depth;
  json["max_depth"] = std::isfinite(arguments.max_depth) ? Json(arguments.max_depth) : Json(nullptr);
  json["fix_convention"] = arguments.fix_convention;
  return json;
}

std::string depthText(const DepthReading& reading) {
  char scale[32];
  std::snprintf(scale, sizeof scale, "%.6g", reading.scale);
  return reading.stored + (reading.kind ? std::string(", ") + nameOf(*reading.kind) : "") +
         (reading.scale == 1 ? "" : std::string(", times ") + scale) + "; invalid: " + reading.invalid;
}

const char* nameOf(DepthKind kind) {
  for (const auto& [name, candidate] : kKinds) {
    if (candidate == kind) return name;
  }
  return "";
}

namespace {

// Any of the readings whose names are words, joined by commas: no list of choices.
void addConventionOption(CLI::App& command, ReadArguments& options) {
  command
      .add_option("--fix-convention", options.fix_convention,
                  "Another reading of poses and depths: auto (what the views agree best under), or a list of "
                  "inverse, transposed, scalar-first, scalar-last, opengl, range, z, depth*FACTOR (see "
                  "vdbfuse info)")
      ->check(conventionCheck())
      ->type_name("NAME")
      ->capture_default_str();
}

void addDepthOptions(CLI::App& command, ReadArguments& options) {
  command
      .add_option_function<double>(
          "--depth-scale", [&options](double scale) { options.depth_scale = scale; },
          "Stored number times this is a length (disparity: pixels, inverse: 1/length)")
      ->check(positiveNumber())
      ->type_name("NUMBER")
      ->option_text("what the format says");
  command
      .add_option_function<std::string>(
          "--depth-kind",
          [&options](const std::string& wanted) {
            for (const auto& [name, kind] : kKinds) {
              if (wanted == name) options.depth_kind = kind;
            }
          },
          "What the stored numbers measure")
      ->transform(oneOf(kindNames()))
      ->type_name("WORD")
      ->option_text("what the format says");
  command
      .add_option_function<double>(
          "--baseline", [&options](double baseline) { options.baseline = baseline; },
          "Distance between the two cameras, for --depth-kind disparity")
      ->check(positiveNumber())
      ->type_name("LENGTH")
      ->option_text("what the files say");
  command.add_option("--min-depth", options.min_depth, "Nearer depths are left out")
      ->check(nonNegativeNumber())
      ->type_name("LENGTH")
      ->capture_default_str();
  command.add_option("--max-depth", options.max_depth, "Further depths are left out")
      ->check(positiveNumber())
      ->type_name("LENGTH")
      ->option_text("none");
}

}  // namespace

void addReadOptions(CLI::App& command, ReadArguments& options) {
  command.option_defaults()->group("Input");
  command.add_option("--format", options.format, "Format of the input")
      ->transform(oneOf(formatNames()))
      ->type_name("WORD")
      ->option_text("what the input looks like");
  addDepthOptions(command, options);
  command
      .add_option_function<std::vector<double>>(
          "--intrinsics",
          [&options](const std::vector<double>& v) {
            options.intrinsics = {{v[0], v[1], v[2], v[3]}};
          },
          "Of the depth camera, in place of what the data set says or lacks")
      ->delimiter(',')
      ->expected(4)
      ->type_name("fx,fy,cx,cy")
      ->option_text("what the files say");
  command
      .add_option_function<double>(
          "--splat-step", [&options](double degrees) { options.splat_step = degrees * kRadiansPerDegree; },
          "Between pixels of the depth maps that points without rows and columns are made into")
      ->check(numberBetween(1e-4, 20.0))
      ->type_name("DEGREES")
      ->option_text("as the points are spaced");
  addConventionOption(command, options);
  command
      .add_option("--masks", options.masks, "Folder of silhouettes NAME.png, black where the object is not")
      ->type_name("FOLDER")
      ->option_text("what lies in the data set");
}

}  // namespace vdbfuse::tool
