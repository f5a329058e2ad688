// SPDX-License-Identifier: Apache-2.0
// The vote of votes.h for many pixels at once, where nobody has more than one peak a pixel: along a surface
// that is known. Written once for each instruction set; the best one is chosen at run time.
#pragma once

#include <cstddef>
#include <span>

#include "stereo/sweep_kernels.h"

namespace vdbfuse::stereo {

/// The peaks of one voter, one a pixel. Rows begin where a widest vector may.
struct VoterRows {
  const float* step = nullptr;
  const float* score = nullptr;      ///< not above 0: no vote
  const float* curvature = nullptr;  ///< BestPeaks::curvature, above 0
};

/// What each pixel voted for: the fields of Mode, all 0 where nobody voted.
struct ModeRows {
  AlignedFloats step, score, support, spread2;
  AlignedInts voters;
  /// C(k) of the best peak, a partner's or another view's, that lies three sigma or more from `step`.
  AlignedFloats second;
  AlignedFloats memory;  ///< for the next call
};

/// The best mode of the first `pixels` pixels, a multiple of kVectorLanes, as Voting has it: of the voters'
/// steps the one with the largest C (the first of equals), moved by four mean shifts. W is cut off at four
/// sigma. The first `partners` of `voters` are partners, the others depths of other views. A pixel's result
/// depends on nothing but its own peaks.
void countVotes(std::span<const VoterRows> voters, std::size_t partners, float sigma, std::size_t pixels,
                ModeRows& modes);

}  // namespace vdbfuse::stereo
