// SPDX-License-Identifier: Apache-2.0
#include "fusion/visibility_integral.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse {
namespace {

// With K midpoints in u = v^a the smallest v is (½/K)^(1/a); below 1/N nothing changes any more.
int nodesFor(double a, double views) {
  const double needed = 0.5 * std::pow(std::max(views, 1.0), a);
  return std::clamp(8 * static_cast<int>(std::ceil(needed / 8.0)), 8, 64);
}

std::vector<double> visibilityNodes(double a, double visibility, double views) {
  if (visibility > 0) return {visibility};
  const int count = nodesFor(a, views);
  std::vector<double> nodes;
  for (int k = 0; k < count; ++k) nodes.push_back(std::pow((k + 0.5) / count, 1.0 / a));
  return nodes;
}

}  // namespace

VisibilityIntegral::VisibilityIntegral(double a, double visibility, double views) {
  const std::vector<double> nodes = visibilityNodes(a, visibility, views);
  nodes_ = static_cast<int>(nodes.size());
  const int rows = static_cast<int>(2 * kRange * kStepsPerUnit) + 2;
  for (int row = 0; row < rows; ++row) {
    const double excess = std::expm1(row / static_cast<double>(kStepsPerUnit) - kRange);
    for (const double v : nodes)
      table_.push_back(static_cast<float>(std::log1p(std::max(v * excess, -1.0 + 1e-12))));
  }
  // ∫ a v^(a−1) (1−v)ⁿ dv = Γ(a+1) Γ(n+1)/Γ(a+n+1).
  for (int n = 0; n <= static_cast<int>(std::ceil(views)) + 1; ++n) {
    const double log_integral = visibility > 0
                                    ? n * std::log1p(-std::min(visibility, 1 - 1e-12))
                                    : std::lgamma(a + 1) + std::lgamma(n + 1) - std::lgamma(a + n + 1);
    half_denial_.push_back(-0.5 * log_integral);
  }
}

void VisibilityIntegral::add(float log_ratio, float weight, float* sums) const {
  const Row row = rowOf(log_ratio);
  for (int k = 0; k < nodes_; ++k) sums[k] += weight * (row.low[k] + row.share * (row.high[k] - row.low[k]));
}

double VisibilityIntegral::logMean(const float* sums) const {
  const double largest = *std::max_element(sums, sums + nodes_);
  double sum = 0;
  for (int k = 0; k < nodes_; ++k) sum += std::exp(sums[k] - largest);
  return largest + std::log(sum / nodes_);
}

double VisibilityIntegral::halfDenial(double n) const {
  const double place = std::clamp(n, 0.0, static_cast<double>(half_denial_.size()) - 1.0 - 1e-9);
  const std::size_t i = static_cast<std::size_t>(place);
  return half_denial_[i] + (place - static_cast<double>(i)) * (half_denial_[i + 1] - half_denial_[i]);
}

}  // namespace vdbfuse
