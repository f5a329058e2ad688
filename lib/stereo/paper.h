// SPDX-License-Identifier: Apache-2.0
// Mode `paper`: section 3.1 of Hernández, Vogiatzis, Cipolla 2007 to the letter, one pixel at a time, in
// double precision. The oracle for the fast path.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "stereo/matching_constants.h"
#include "vdbfuse/stereo/stereo.h"

namespace vdbfuse::stereo {

struct PaperOptions {
  /// What the curves of the partners are made into.
  enum class Score {
    Votes,  ///< the paper's: votes of their local maxima
    Mean,   ///< the mean of the curves: what voting is compared with
  };
  Score score = Score::Votes;
  int window_px = 7;
  int hypotheses = 1;
  double min_confidence = 0;
  double threshold = kFirstThreshold;  ///< t
  double step_px = kPaperStep;
};

/// D(p) = argmax C(d) for each pixel p, confidence C(D)/M (at most 1: several maxima of one partner may lie
/// close together), M the number of partners; second_best is that of the best depth more than 3 kVoteSigma
/// away; voters are the partners with a maximum within kVoteSigma; the shares of alternatives are in
/// proportion to C. No depth where no partner votes, or with less than min_confidence. Windows that leave the
/// picture or the mask, or lack texture, cast no vote.
///
/// Sets name, camera, pose, mask and `depths` too; not colour, the numbers of the partners, matching error
/// and noise. The same for any number of threads. `done` is told of rows that are done, from any thread; what
/// it throws reaches the caller.
StereoView paperDepthMap(const Photograph& reference, const std::vector<Photograph>& partners,
                         const DepthInterval& depths, const PaperOptions& options = {},
                         const std::function<void(std::size_t rows)>& done = {});

}  // namespace vdbfuse::stereo
