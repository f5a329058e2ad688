// SPDX-License-Identifier: Apache-2.0
// The sweeps that follow: along the slant of what was found before (Collins 1996 sweeps planes; here every
// pixel of a window has an inverse depth of its own).
#pragma once

#include <vector>

#include "stereo/cross_view.h"
#include "stereo/match_stage.h"
#include "stereo/surface.h"

namespace vdbfuse::stereo {

/// Peaks of all partners around `before`, ± `reach` steps, and what other views say. What is not found keeps
/// its value and half its score.
DepthLayer surfaceSweep(const Stage& stage, const DepthLayer& before, int reach,
                        const std::vector<Testimony>& others = {});

/// The depth that most of the pixel's own and those of other views agree with; the score of both.
DepthLayer agreed(const Stage& stage, const DepthLayer& own, const std::vector<Testimony>& others);

}  // namespace vdbfuse::stereo
