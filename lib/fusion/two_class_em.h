// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
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

/// What is held of the values of the first observation before any data: the probability of the outlier class,
/// or nothing where the value says nothing of it.
struct FirstOpinion {
  std::vector<std::optional<double>> outlier;
  /// How many counts the opinion on a value weighs, in counts of that value.
  double trust = 10.0;
};

/// Two classes (inlier, outlier) with observations that are independent given the class.
struct TwoClassModel {
  /// p(outlier | first observation).
  std::vector<double> first;
  /// p(value | class) of the others: [observation − 1][value].
  std::vector<std::vector<double>> inlier, outlier;

  /// Posterior probability of the outlier class. One value an observation.
  double outlierGiven(std::span<const std::size_t> values) const;
};

/// Expectation–maximisation. Two free histograms over one observation do not determine a mixture, and on
/// clean data, or where views are few, nothing else is there: the classes would drift to whatever splits the
/// data. So the first observation is tied to an opinion (its conjugate prior, `trust` times the data), and a
/// value without one takes the outlier share that the others have at the same value of the second
/// observation. Histograms are smoothed by one count.
TwoClassModel fitTwoClasses(const JointCounts& joint, const FirstOpinion& opinion);

}  // namespace vdbfuse
