// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace vdbfuse {

/// Two classes (inlier, outlier), two discrete observations a and b that are independent given the class.
struct TwoClassModel {
  double outlier_share = 0;
  std::vector<double> inlier_a, outlier_a;  ///< p(a | class)
  std::vector<double> inlier_b, outlier_b;  ///< p(b | class)

  /// Posterior probability of the outlier class.
  double outlierGiven(std::size_t a, std::size_t b) const;
};

/// Joint counts of the two observations, row by row: counts[a·size_b + b].
struct JointCounts {
  std::size_t size_a = 0, size_b = 0;
  std::vector<double> counts;
  double& at(std::size_t a, std::size_t b) { return counts[a * size_b + b]; }
  double at(std::size_t a, std::size_t b) const { return counts[a * size_b + b]; }
};

/// Expectation–maximisation from a first posterior `outlier[a·size_b + b]`. Histograms are smoothed by one
/// count.
TwoClassModel fitTwoClasses(const JointCounts& joint, std::vector<double> outlier);

}  // namespace vdbfuse
