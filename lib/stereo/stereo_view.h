// SPDX-License-Identifier: Apache-2.0
// From what was found of a photograph to what is handed out.
#pragma once

#include <cstddef>

#include "stereo/match_view.h"
#include "stereo/stereo_plan.h"
#include "vdbfuse/stereo/stereo.h"

namespace vdbfuse::stereo {

/// Everything but the depths and what is known of them.
StereoView viewWithoutDepths(const StereoPlan& plan, std::size_t index, Photograph photograph);

/// `full_score`: of complete agreement. `pixel`: inverseDepthOfPixel() of level 0.
void storeDepths(const ViewMatch& match, float full_score, float pixel, const StereoOptions& options,
                 StereoView& view);

}  // namespace vdbfuse::stereo
