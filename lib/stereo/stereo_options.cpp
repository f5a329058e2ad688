// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/stereo/stereo_options.h"

#include <cmath>

namespace vdbfuse {

std::vector<std::string> validate(const StereoOptions& options) {
  std::vector<std::string> problems;
  const auto require = [&](bool holds, const char* sentence) {
    if (!holds) problems.emplace_back(sentence);
  };
  const PartnerOptions& partners = options.partners;
  require(partners.count >= 1 && partners.count <= 64, "partners.count must be 1 to 64");
  require(partners.min_angle_deg >= 0 && partners.max_angle_deg > partners.min_angle_deg &&
              partners.max_angle_deg <= 180,
          "the angles of partners must be 0 <= min < max <= 180 degrees");
  require(options.window_px >= 3 && options.window_px <= 15 && options.window_px % 2 == 1,
          "window_px must be odd, 3 to 15");
  require(options.min_depth >= 0, "min_depth must not be below 0");
  require(options.max_depth >= 0 && std::isfinite(options.max_depth), "max_depth must not be below 0");
  require(options.max_depth == 0 || options.max_depth > options.min_depth,
          "max_depth must be above min_depth");
  require(options.hypotheses >= 1 && options.hypotheses <= 4, "hypotheses must be 1 to 4");
  require(options.min_confidence >= 0 && options.min_confidence <= 1, "min_confidence must be in [0, 1]");
  require(options.surface_sweeps >= 0 && options.surface_sweeps <= 10, "surface_sweeps must be 0 to 10");
  return problems;
}

}  // namespace vdbfuse
