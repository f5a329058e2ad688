// SPDX-License-Identifier: Apache-2.0
#include "fusion/two_class_em.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse {
namespace {

void normalise(std::vector<double>& histogram) {
  double sum = 0;
  for (double& h : histogram) sum += h += 1.0;
  for (double& h : histogram) h /= sum;
}

// Histograms of both classes from the posterior of each joint cell.
TwoClassModel maximise(const JointCounts& joint, const std::vector<double>& outlier) {
  TwoClassModel model{0, std::vector<double>(joint.size_a), std::vector<double>(joint.size_a),
                      std::vector<double>(joint.size_b), std::vector<double>(joint.size_b)};
  double total = 0;
  for (std::size_t a = 0; a < joint.size_a; ++a) {
    for (std::size_t b = 0; b < joint.size_b; ++b) {
      const double count = joint.at(a, b), bad = count * outlier[a * joint.size_b + b];
      model.inlier_a[a] += count - bad, model.outlier_a[a] += bad;
      model.inlier_b[b] += count - bad, model.outlier_b[b] += bad;
      model.outlier_share += bad, total += count;
    }
  }
  model.outlier_share = (model.outlier_share + 1) / (total + 2);
  for (auto* histogram : {&model.inlier_a, &model.outlier_a, &model.inlier_b, &model.outlier_b})
    normalise(*histogram);
  return model;
}

}  // namespace

double TwoClassModel::outlierGiven(std::size_t a, std::size_t b) const {
  const double bad = outlier_share * outlier_a[a] * outlier_b[b];
  const double good = (1 - outlier_share) * inlier_a[a] * inlier_b[b];
  return bad / (bad + good);
}

TwoClassModel fitTwoClasses(const JointCounts& joint, std::vector<double> outlier) {
  constexpr int kIterations = 200;
  constexpr double kConverged = 1e-5;
  TwoClassModel model;
  for (int i = 0; i < kIterations; ++i) {
    model = maximise(joint, outlier);
    double change = 0;
    for (std::size_t k = 0; k < outlier.size(); ++k) {
      const double next = model.outlierGiven(k / joint.size_b, k % joint.size_b);
      change = std::max(change, std::abs(next - outlier[k]));
      outlier[k] = next;
    }
    if (change < kConverged) break;
  }
  return model;
}

}  // namespace vdbfuse
