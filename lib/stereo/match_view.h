// SPDX-License-Identifier: Apache-2.0
// Depths of one photograph by sweeping over its partners: planes first, over all depths at a coarse level;
// then along the surface that was found, on finer and finer levels.
#pragma once

#include <vector>

#include "stereo/cross_view.h"
#include "stereo/match_stage.h"
#include "stereo/surface.h"

namespace vdbfuse::stereo {

/// Levels of the pyramid that matchView() needs for pictures of this size.
int levelsFor(int width, int height, const StereoOptions& options);

/// Of level 0.
struct ViewMatch {
  DepthLayer best;
  /// What else the first sweep found, where StereoOptions::hypotheses are more than one: its modes, the best
  /// first (which may be the depth that `best` came from), as exact as that sweep.
  std::vector<DepthLayer> modes;
};
ViewMatch matchView(const MatchInput& input, const StereoOptions& options);

/// Weighs the depths against what other views say of them, and sweeps once more along the result, ± `reach`
/// steps.
DepthLayer crossChecked(const MatchInput& input, const StereoOptions& options, const DepthLayer& own,
                        const std::vector<Testimony>& others, int reach);

}  // namespace vdbfuse::stereo
