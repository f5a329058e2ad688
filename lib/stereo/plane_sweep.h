// SPDX-License-Identifier: Apache-2.0
// The first sweep: planes that face the camera, over all depths.
#pragma once

#include <vector>

#include "stereo/match_stage.h"
#include "stereo/surface.h"

namespace vdbfuse::stereo {

/// How many of its peaks a partner votes with.
enum class PartnerVotes {
  Best,  ///< the best one near k: C(k) = Σ_j max_i S_ji W(k − k_ji)
  All,   ///< the paper's: C(k) = Σ_j Σ_i S_ji W(k − k_ji)
};

struct PlaneSweepOptions {
  float step = 0;   ///< inverse depth from one plane to the next
  float sigma = 2;  ///< of a vote, in steps
  PartnerVotes votes = PartnerVotes::Best;
  int hypotheses = 1;
};

/// The modes of every pixel's votes (Hernández et al. 2007, sec. 3.1), the best first: one layer for each of
/// `hypotheses`.
std::vector<DepthLayer> planeSweep(const Stage& stage, const PlaneSweepOptions& options);

}  // namespace vdbfuse::stereo
