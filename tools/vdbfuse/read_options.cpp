// SPDX-License-Identifier: Apache-2.0
#include "read_options.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

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
  return names;
}

}  // namespace

const char* nameOf(DepthKind kind) {
  for (const auto& [name, candidate] : kKinds) {
    if (candidate == kind) return name;
  }
  return "";
}

void addReadOptions(CLI::App& command, ReadOptions& options) {
  const char* group = "Input";
  command.add_option("--format", options.format, "Format of the input, if looking at it is not enough")
      ->check(CLI::IsMember(formatNames()))
      ->group(group);
  command
      .add_option_function<double>(
          "--depth-scale", [&options](double scale) { options.depth_scale = scale; },
          "Stored number times this is a length (disparity: pixels, inverse: 1/length)")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command
      .add_option_function<std::string>(
          "--depth-kind",
          [&options](const std::string& wanted) {
            for (const auto& [name, kind] : kKinds) {
              if (wanted == name) options.depth_kind = kind;
            }
          },
          "What the stored numbers measure")
      ->check(CLI::IsMember(kindNames()))
      ->group(group);
  command
      .add_option_function<double>(
          "--baseline", [&options](double baseline) { options.baseline = baseline; },
          "Distance between the two cameras, for --depth-kind disparity")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command
      .add_option("--masks", options.masks,
                  "Folder of silhouettes NAME.png, black where the object is not; default: what lies in the "
                  "data set")
      ->group(group);
  command.add_option("--min-depth", options.min_depth, "Nearer depths are left out")
      ->check(CLI::NonNegativeNumber)
      ->group(group);
  command.add_option("--max-depth", options.max_depth, "Further depths are left out")
      ->check(CLI::PositiveNumber)
      ->group(group);
}

}  // namespace vdbfuse::tool
