// SPDX-License-Identifier: Apache-2.0
// From the peaks of all partners to one depth: occlusion-robust voting (Hernández et al. 2007, sec. 3.1). A
// partner that does not see the point votes elsewhere or not at all, so that occlusion is noise.
//
//     C(k) = Σ_j max_i S_ji W(k − k_ji):
//
// every voter j votes once, with its best peak near k. W is a Gaussian, cut off at four sigma. Written once
// for each instruction set; the best one is chosen at run time.
#pragma once

#include <cstddef>
#include <span>

#include "stereo/sweep_kernels.h"

namespace vdbfuse::stereo {

/// Peaks of one voter, one a pixel. Those of a voter with several follow each other. Rows begin where a
/// widest vector may.
struct VoterRows {
  const float* step = nullptr;
  const float* score = nullptr;      ///< not above 0: no vote
  const float* curvature = nullptr;  ///< BestPeaks::curvature, above 0
  int voter = 0;
};

/// A mode of C at each pixel; all 0 where there is none.
struct ModeRows {
  AlignedFloats step;     ///< k
  AlignedFloats score;    ///< C(k) of the partners; at most their number
  AlignedFloats support;  ///< C(k) of the other voters
  AlignedFloats
      second;  ///< C of the best of all peaks that lie three sigma or more from this mode and better ones
  AlignedInts voters;     ///< partners with a peak within two sigma
  AlignedFloats spread2;  ///< mean square distance of their peaks from k, in steps
};

/// The best modes of the first `pixels` pixels, a multiple of kVectorLanes, as many as `modes` has places: of
/// the peaks the one with the largest C (the first of equals), moved by four mean shifts that weigh the votes
/// by their curvature; then the same for the peaks that lie three sigma or more from the modes found. The
/// first `partners` of `rows` are those of partners, the others depths of other views. A pixel's result
/// depends on nothing but its own peaks.
void countVotes(std::span<const VoterRows> rows, std::size_t partners, float sigma, std::size_t pixels,
                std::span<ModeRows> modes);

}  // namespace vdbfuse::stereo
