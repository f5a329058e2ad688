// SPDX-License-Identifier: Apache-2.0
// The first sweep: planes that face the camera, over all depths.
#pragma once

#include <vector>

#include "stereo/match_stage.h"
#include "stereo/surface.h"

namespace vdbfuse::stereo {

/// The modes of every pixel's votes (Hernández et al. 2007, sec. 3.1), the best first: one layer for each of
/// `hypotheses`. `step_px`: pixels of the widest partner from one plane to the next.
std::vector<DepthLayer> planeSweep(const Stage& stage, float step_px, int hypotheses);

}  // namespace vdbfuse::stereo
