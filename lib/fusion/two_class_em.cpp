// SPDX-License-Identifier: Apache-2.0
#include "fusion/two_class_em.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace vdbfuse {
namespace {

using Histograms = std::vector<std::vector<double>>;

Histograms emptyHistograms(const std::vector<std::size_t>& sizes) {
  Histograms histograms;
  for (const std::size_t size : sizes) histograms.emplace_back(size, 1.0);
  return histograms;
}

void normalise(Histograms& histograms) {
  for (std::vector<double>& h : histograms) {
    const double sum = std::accumulate(h.begin(), h.end(), 0.0);
    for (double& value : h) value /= sum;
  }
}

// Histograms of both classes from the posterior of each joint cell.
TwoClassModel maximise(const JointCounts& joint, const std::vector<double>& outlier) {
  TwoClassModel model{0, emptyHistograms(joint.sizes), emptyHistograms(joint.sizes)};
  double total = 0, bad_total = 0;
  for (std::size_t k = 0; k < joint.counts.size(); ++k) {
    if (joint.counts[k] == 0) continue;
    const double bad = joint.counts[k] * outlier[k];
    const std::vector<std::size_t> values = joint.values(k);
    for (std::size_t i = 0; i < values.size(); ++i) {
      model.inlier[i][values[i]] += joint.counts[k] - bad;
      model.outlier[i][values[i]] += bad;
    }
    total += joint.counts[k], bad_total += bad;
  }
  model.outlier_share = (bad_total + 1) / (total + 2);
  normalise(model.inlier);
  normalise(model.outlier);
  return model;
}

}  // namespace

JointCounts::JointCounts(std::vector<std::size_t> observation_sizes)
    : sizes(std::move(observation_sizes)),
      counts(std::accumulate(sizes.begin(), sizes.end(), std::size_t{1}, std::multiplies<>())) {}

std::size_t JointCounts::index(std::span<const std::size_t> values) const {
  std::size_t index = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) index = index * sizes[i] + values[i];
  return index;
}

std::vector<std::size_t> JointCounts::values(std::size_t index) const {
  std::vector<std::size_t> result(sizes.size());
  for (std::size_t i = sizes.size(); i-- > 0; index /= sizes[i]) result[i] = index % sizes[i];
  return result;
}

double TwoClassModel::outlierGiven(std::span<const std::size_t> values) const {
  double bad = outlier_share, good = 1 - outlier_share;
  for (std::size_t i = 0; i < values.size(); ++i) {
    bad *= outlier[i][values[i]];
    good *= inlier[i][values[i]];
  }
  return bad / (bad + good);
}

TwoClassModel fitTwoClasses(const JointCounts& joint, std::vector<double> outlier) {
  constexpr int kIterations = 200;
  constexpr double kConverged = 1e-4;
  TwoClassModel model;
  for (int i = 0; i < kIterations; ++i) {
    model = maximise(joint, outlier);
    double change = 0;
    for (std::size_t k = 0; k < outlier.size(); ++k) {
      if (joint.counts[k] == 0) continue;
      const double next = model.outlierGiven(joint.values(k));
      change = std::max(change, std::abs(next - outlier[k]));
      outlier[k] = next;
    }
    if (change < kConverged) break;
  }
  return model;
}

}  // namespace vdbfuse
