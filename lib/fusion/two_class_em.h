// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace vdbfuse {

/// Joint counts of some discrete observations; the last one runs fastest.
struct JointCounts {
  explicit JointCounts(std::vector<std::size_t> observation_sizes);
  std::vector<std::size_t> sizes;
  std::vector<double> counts;
  std::size_t index(std::span<const std::size_t> values) const;
  std::vector<std::size_t> values(std::size_t index) const;
};

/// Two classes (inlier, outlier) with observations that are independent given the class.
struct TwoClassModel {
  double outlier_share = 0;
  /// p(value | class): [observation][value].
  std::vector<std::vector<double>> inlier, outlier;

  /// Posterior probability of the outlier class. One value an observation.
  double outlierGiven(std::span<const std::size_t> values) const;
};

/// Expectation–maximisation from a first posterior, one for each joint count. Histograms are smoothed by one
/// count.
TwoClassModel fitTwoClasses(const JointCounts& joint, std::vector<double> outlier);

}  // namespace vdbfuse
