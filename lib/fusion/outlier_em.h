// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace vdbfuse {

/// Pixels of which the same was observed.
struct OutlierCell {
  double count = 0;
  double ratio = 1;            ///< p(observation | outlier)/p(observation | inlier), known beforehand
  std::size_t kind = 0;        ///< pixels of different kinds have different shares of outliers
  std::size_t confidence = 0;  ///< bin
};

/// What is learned: the outlier share of each kind, and p(bin | outlier)/p(bin | inlier) of each confidence.
struct OutlierModel {
  std::vector<double> share_by_kind;
  std::vector<double> confidence_ratio;

  /// Posterior probability of an outlier: of odds, share × ratio × confidence ratio.
  double outlierGiven(double ratio, std::size_t kind, std::size_t confidence) const;
};

/// Expectation–maximisation. The ratios hold the two classes in place, so that there is one answer, on clean
/// data and with few views as well: were they learned, too, the classes would drift to whatever splits the
/// data. Confidence and observation are independent given the class; histograms are smoothed by one count.
OutlierModel fitOutliers(const std::vector<OutlierCell>& cells, std::size_t kinds, std::size_t confidences);

}  // namespace vdbfuse
