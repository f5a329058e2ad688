// SPDX-License-Identifier: Apache-2.0
// Mode `paper`: what the partners' curves say together,
//
//   C(d) = Σ_j Σ_k S_j(d_jk) W(d − d_jk),  d_jk: the local maxima of S_j with S_j(d_jk) > t
//
// (Hernández et al. 2007, sec. 3.1). A partner that does not see the point votes elsewhere or not at all.
// Depths are counted in steps.
#pragma once

#include <cstddef>
#include <vector>

namespace vdbfuse::stereo::paper {

/// One vote: d_jk and S_j(d_jk).
struct Vote {
  double step = 0, score = 0;
  std::size_t partner = 0;
};

/// A depth with its score.
struct Mode {
  double step = 0, score = 0;
};

/// The local maxima of a curve above the threshold, by the parabola through three samples. What has no score
/// on one side, or the end of the curve, is no maximum.
std::vector<Vote> localMaxima(const std::vector<double>& curve, double threshold, std::size_t partner);

/// C(d); W = 1 in the middle, standard deviation kVoteSigma.
double votesAt(const std::vector<Vote>& votes, double step);

/// Maxima of C, the best first (of equal ones that of the first vote), each more than 3 kVoteSigma from all
/// better ones. Found by mean shift from every vote.
std::vector<Mode> modesOf(const std::vector<Vote>& votes);

/// The baseline that voting is compared with: maxima of the mean of all curves, where it is above 0; each
/// step over the partners that have a score there.
std::vector<Mode> modesOfMean(const std::vector<std::vector<double>>& curves);

/// Number of partners with a vote within kVoteSigma of a depth.
std::size_t votersAt(const std::vector<Vote>& votes, double step);

}  // namespace vdbfuse::stereo::paper
