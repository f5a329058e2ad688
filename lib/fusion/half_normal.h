// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace vdbfuse {

/// Mixture of a half-normal distribution of scale σ and a uniform one on [0, largest value].
struct HalfNormalFit {
  double scale = 0;  ///< σ
  double inlier_share = 0;
  double log_likelihood = 0;  ///< of all values
};

/// Maximum likelihood by EM. REQUIRES: values ≥ 0, not empty.
HalfNormalFit fitHalfNormal(const std::vector<double>& values);

}  // namespace vdbfuse
