// SPDX-License-Identifier: Apache-2.0
#include "fusion/half_normal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vdbfuse {
namespace {

double startingScale(std::vector<double> values) {
  // The 30 % quantile of a half-normal distribution lies at 0.385 σ and is hardly moved by outliers.
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 3 / 10);
  std::nth_element(values.begin(), nth, values.end());
  return *nth / 0.385;
}

// One step of EM; also the likelihood of the fit it started from.
HalfNormalFit step(const std::vector<double>& values, const HalfNormalFit& fit, double uniform_density) {
  const double peak = fit.inlier_share * std::sqrt(2 / std::numbers::pi) / fit.scale;
  const double flat = (1 - fit.inlier_share) * uniform_density;
  double inliers = 0, squares = 0, likelihood = 0;
  for (const double v : values) {
    const double u = v / fit.scale;
    const double inlier = peak * std::exp(-0.5 * u * u);
    const double share = inlier / (inlier + flat);
    inliers += share;
    squares += share * v * v;
    likelihood += std::log(inlier + flat);
  }
  HalfNormalFit next;
  next.inlier_share = std::clamp(inliers / static_cast<double>(values.size()), 0.01, 0.999);
  next.scale = std::sqrt(squares / std::max(inliers, 1e-12));
  next.log_likelihood = likelihood;
  return next;
}

}  // namespace

HalfNormalFit fitHalfNormal(const std::vector<double>& values) {
  const double largest = *std::max_element(values.begin(), values.end());
  const double smallest_scale = std::max(largest * 1e-9, std::numeric_limits<double>::min());
  HalfNormalFit fit{std::max(startingScale(values), smallest_scale), 0.8, 0};
  constexpr int kIterations = 60;
  for (int i = 0; i < kIterations; ++i) {
    HalfNormalFit next = step(values, fit, 1 / std::max(largest, smallest_scale));
    next.scale = std::max(next.scale, smallest_scale);
    const bool converged = std::abs(next.scale - fit.scale) < 1e-5 * fit.scale;
    fit = next;
    if (converged) break;
  }
  return fit;
}

}  // namespace vdbfuse
