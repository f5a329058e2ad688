// SPDX-License-Identifier: Apache-2.0
#include "stereo_arguments.h"

#include <algorithm>
#include <utility>

#include "cli/number_check.h"
#include "cli/one_of.h"

namespace vdbfuse::tool {
namespace {

const std::map<std::string, StereoOptions::Mode> kModes = {{"fast", StereoOptions::Mode::Fast},
                                                           {"paper", StereoOptions::Mode::Paper}};

}  // namespace

std::vector<CLI::Option*> addStereoOptions(CLI::App& app, StereoOptions& options, const std::string& group) {
  const CLI::Validator angle = numberBetween(0, 180);
  std::vector<CLI::Option*> all = {
      addChoice(app, "--mode", options.mode, kModes,
                "fast: sweeps over a pyramid; paper: section 3.1 of the paper to the letter, slow"),
      app.add_option("--neighbours", options.partners.count, "Photographs that each is matched with")
          ->type_name("N")
          ->check(numberBetween(1, 64))
          ->capture_default_str(),
      app.add_option("--min-angle", options.partners.min_angle_deg,
                     "Least angle between the lines of sight of two that are matched")
          ->type_name("DEGREES")
          ->check(angle)
          ->capture_default_str(),
      app.add_option("--max-angle", options.partners.max_angle_deg, "Largest angle")
          ->type_name("DEGREES")
          ->check(angle)
          ->capture_default_str(),
      app.add_option("--window", options.window_px, "Side of the square that is correlated; odd")
          ->type_name("PIXELS")
          ->check(numberBetween(3, 15))
          ->capture_default_str(),
      app.add_option("--hypotheses", options.hypotheses, "Depths a pixel may have")
          ->type_name("N")
          ->check(numberBetween(1, 4))
          ->capture_default_str(),
      app.add_option("--min-confidence", options.min_confidence, "Pixels with less have no depth")
          ->type_name("SHARE")
          ->check(numberBetween(0.0, 1.0))
          ->capture_default_str(),
      app.add_option("--surface-sweeps", options.surface_sweeps,
                     "Of --mode fast: sweeps along the slant of what was found before")
          ->type_name("N")
          ->check(numberBetween(0, 10))
          ->capture_default_str(),
      app.add_flag_callback(
          "--no-cross-check", [&options] { options.cross_check = StereoOptions::CrossCheck::Off; },
          "Of --mode fast: leave out the pass that weighs the depth maps against each other")};
  for (CLI::Option* option : all) option->group(group);
  return all;
}

ImageSet readPhotographs(const std::filesystem::path& path, const ImageReadOptions& options,
                         std::size_t most) {
  ImageSet set = readImageSet(path, options);
  if (most > 0) set.photographs = set.photographs.first(most);
  return set;
}

Json jsonOf(const StereoOptions& options) {
  const bool is_fast = options.mode == StereoOptions::Mode::Fast;
  Json json = {{"mode", is_fast ? "fast" : "paper"},
               {"neighbours", options.partners.count},
               {"min_angle_deg", options.partners.min_angle_deg},
               {"max_angle_deg", options.partners.max_angle_deg},
               {"window_px", options.window_px},
               {"bbox", nullptr},
               {"min_depth", options.min_depth},
               {"max_depth", options.max_depth},
               {"hypotheses", options.hypotheses},
               {"min_confidence", options.min_confidence},
               {"surface_sweeps", options.surface_sweeps},
               {"cross_check", options.cross_check == StereoOptions::CrossCheck::On}};
  if (options.domain) {
    const Eigen::Vector3d low = options.domain->min(), high = options.domain->max();
    json["bbox"] = {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
  }
  return json;
}

}  // namespace vdbfuse::tool
