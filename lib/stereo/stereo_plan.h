// SPDX-License-Identifier: Apache-2.0
// What is decided before the first picture is loaded.
#pragma once

#include <vector>

#include "vdbfuse/sensor/photograph.h"
#include "vdbfuse/stereo/stereo_options.h"

namespace vdbfuse::stereo {

/// Of each photograph.
struct StereoPlan {
  std::vector<PhotographHeader> headers;
  std::vector<DepthInterval> depths;
  std::vector<std::vector<std::size_t>> partners;
};

/// Throws InvalidArgument where no depths are left, or none can be found (depthsOf()).
StereoPlan stereoPlan(const PhotographSequence& photographs, const StereoOptions& options);

}  // namespace vdbfuse::stereo
