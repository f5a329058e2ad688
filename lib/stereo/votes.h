// SPDX-License-Identifier: Apache-2.0
// From the peaks of all partners to one depth: occlusion-robust voting (Hernández et al. 2007, sec. 3.1). A
// partner that does not see the point votes elsewhere or not at all, so that occlusion is noise.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "stereo/sweep_kernels.h"

namespace vdbfuse::stereo {

/// How many of its peaks a partner votes with.
enum class PartnerVotes {
  Best,  ///< the best one near k: C(k) = Σ_j max_i S_ji W(k − k_ji)
  All,   ///< the paper's: C(k) = Σ_j Σ_i S_ji W(k − k_ji)
};

/// A mode of C(k).
struct Mode {
  float step = 0;           ///< k, by mean shift
  float score = 0;          ///< C(k) of the partners; at most their number where each votes once
  float support = 0;        ///< C(k) of other views' depths (Peak::partner from kOtherViews on)
  std::uint8_t voters = 0;  ///< partners with a peak within two sigma
  float spread2 = 0;        ///< mean square distance of their peaks from k, in steps
};

/// Peaks of other views' depths have numbers from here on.
inline constexpr std::int32_t kOtherViews = 1 << 16;

/// What one pixel voted for, the best first; modes nearer than three sigma to a better one are left out.
using Modes = std::vector<Mode>;

class Voting {
 public:
  /// `sigma`: of W, in steps.
  Voting(float sigma, std::size_t most_modes, PartnerVotes votes = PartnerVotes::Best);

  /// REQUIRES: peaks ordered by partner. The result lives until the next call.
  const Modes& count(const std::vector<Peak>& peaks);

 private:
  template <class Use>
  void forEachVoter(const std::vector<Peak>& peaks, float step, const Use& use) const;
  /// W of a distance below four sigma.
  float weight(float distance) const;
  float scoreAt(const std::vector<Peak>& peaks, float step) const;
  Mode shifted(const std::vector<Peak>& peaks, float step) const;

  float sigma_, reach_;
  std::size_t most_modes_;
  PartnerVotes votes_;
  std::vector<float> table_;
  Modes modes_;
  std::vector<std::pair<float, float>> candidates_;
};

}  // namespace vdbfuse::stereo
