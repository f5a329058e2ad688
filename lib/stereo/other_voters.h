// SPDX-License-Identifier: Apache-2.0
// Depths of other views as voters beside the partners.
#pragma once

#include <vector>

#include "stereo/cross_view.h"
#include "stereo/vote_kernels.h"

namespace vdbfuse::stereo {

inline constexpr float kOtherViewsWeight = 1.0F;     ///< of another view's depth, beside a partner's peak
inline constexpr float kOtherViewsCurvature = 1.0F;  ///< how well it knows its place

/// Rows of one view after the other, each as long as those of the tile without margin.
struct OtherVoters {
  AlignedFloats step, score, curvature;
};

/// What the views say of the windows of a tile (of its size, base and inverse spread) that is swept over
/// `range`. What landed beside a pixel is brought there along the slant of `planes`. Replaces `memory` and
/// adds it to `rows`, each view as a new voter.
void addOtherVoters(const std::vector<Testimony>& others, const PlaneMap& planes, const SweepTile& tile,
                    const SweepRange& range, OtherVoters& memory, std::vector<VoterRows>& rows);

}  // namespace vdbfuse::stereo
