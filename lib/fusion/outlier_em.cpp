// SPDX-License-Identifier: Apache-2.0
#include "fusion/outlier_em.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vdbfuse {
namespace {

constexpr double kFirstShare = 0.2, kLeastShare = 1e-5;
// The share of a kind leans on that of all by so many pixels, as a part of all.
constexpr double kLeaning = 0.002;

void normalise(std::vector<double>& histogram) {
  const double sum = std::accumulate(histogram.begin(), histogram.end(), 0.0);
  for (double& value : histogram) value /= sum;
}

// The model from the posterior of each cell.
OutlierModel maximise(const std::vector<OutlierCell>& cells, const std::vector<double>& outlier,
                      std::size_t kinds, std::size_t confidences) {
  std::vector<double> bad(kinds), all(kinds), wrong(confidences, 1.0), right(confidences, 1.0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const OutlierCell& cell = cells[i];
    bad[cell.kind] += cell.count * outlier[i], all[cell.kind] += cell.count;
    wrong[cell.confidence] += cell.count * outlier[i];
    right[cell.confidence] += cell.count * (1 - outlier[i]);
  }
  const double total = std::accumulate(all.begin(), all.end(), 0.0), leaning = kLeaning * total;
  const double share = total > 0 ? std::accumulate(bad.begin(), bad.end(), 0.0) / total : kFirstShare;
  OutlierModel model;
  for (std::size_t k = 0; k < kinds; ++k) {
    const double rate = total > 0 ? (bad[k] + share * leaning) / (all[k] + leaning) : share;
    model.share_by_kind.push_back(std::clamp(rate, kLeastShare, 1 - kLeastShare));
  }
  normalise(wrong), normalise(right);
  for (std::size_t c = 0; c < confidences; ++c) model.confidence_ratio.push_back(wrong[c] / right[c]);
  return model;
}

}  // namespace

double OutlierModel::outlierGiven(double ratio, std::size_t kind, std::size_t confidence) const {
  const double bad = share_by_kind[kind] * ratio * confidence_ratio[confidence];
  return bad / (bad + 1 - share_by_kind[kind]);
}

OutlierModel fitOutliers(const std::vector<OutlierCell>& cells, std::size_t kinds, std::size_t confidences) {
  constexpr int kIterations = 300;
  constexpr double kConverged = 1e-4;
  OutlierModel model{std::vector<double>(kinds, kFirstShare), std::vector<double>(confidences, 1.0)};
  std::vector<double> outlier(cells.size(), 0.5);
  for (int i = 0; i < kIterations; ++i) {
    double change = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const double next = model.outlierGiven(cells[k].ratio, cells[k].kind, cells[k].confidence);
      change = std::max(change, std::abs(next - outlier[k]));
      outlier[k] = next;
    }
    if (change < kConverged) break;
    model = maximise(cells, outlier, kinds, confidences);
  }
  return model;
}

}  // namespace vdbfuse
