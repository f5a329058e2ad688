// SPDX-License-Identifier: Apache-2.0
// What is worth knowing of depth maps made from photographs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "json_file.h"
#include "vdbfuse/stereo/stereo.h"

namespace vdbfuse::tool {

struct StereoSummary {
  struct Row {
    std::string name;
    std::vector<std::string> partners;  ///< names
    DepthInterval depths;
    double matching_error_px = 0;
    NoiseLaw noise;
    std::size_t pixels = 0, pixels_with_depth = 0;
    double mean_confidence = 0;  ///< of these; 0: there are none
  };
  std::vector<Row> rows;
  std::vector<StepTime> steps;
};

StereoSummary summarise(const StereoResult& result);

/// An array of objects: name, partners, near, far, matching_error_px, noise_quadratic, pixels,
/// pixels_with_depth, mean_confidence.
Json jsonOf(const StereoSummary& summary);

/// A table for people, a line a view and one for all.
std::string tableOf(const StereoSummary& summary);

}  // namespace vdbfuse::tool
