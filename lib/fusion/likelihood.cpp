// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/fusion/likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace vdbfuse {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Points nearer to an end of the range than this share of it are taken to lie there.
constexpr double kEnd = 0.001;

double logSum(double a, double b) {
  const double larger = std::max(a, b);
  return larger == -kInfinity ? larger : larger + std::log1p(std::exp(std::min(a, b) - larger));
}

// Where a point lies in the range of the sensor.
struct Place {
  Place(const SensorModel& sensor, double at) : range(sensor.far - sensor.near), depth(at) {
    if (!std::isfinite(range)) return;
    t = std::clamp((at - sensor.near) / range, kEnd, 1 - kEnd);
    depth = sensor.near + t * range;
  }
  double logPriorOdds() const { return std::isfinite(range) ? std::log(t / (1 - t)) : 0.0; }

  double range, depth, t = 0.5;
};

// log[(1−ε) Σ share · inliers + ε · outliers]
template <class LogInliers>
double logMixture(const Measurement& m, const LogInliers& log_inliers, double outliers) {
  double sum = m.outlier * outliers > 0 ? std::log(m.outlier * outliers) : -kInfinity;
  for (const Hypothesis& h : std::span(m.hypotheses).first(m.count))
    if (h.share > 0) sum = logSum(sum, std::log((1 - m.outlier) * h.share) + log_inliers(h));
  return sum;
}

double logBehind(const SensorModel& sensor, const Measurement& m, const Place& place) {
  return logMixture(
      m,
      [&](const Hypothesis& h) {
        return sensor.shape.logBetween((h.depth - sensor.far) / h.noise, (h.depth - place.depth) / h.noise);
      },
      1 - place.t);
}

double logBefore(const SensorModel& sensor, const Measurement& m, const Place& place) {
  return logMixture(
      m,
      [&](const Hypothesis& h) {
        return sensor.shape.logBetween((h.depth - place.depth) / h.noise, (h.depth - sensor.near) / h.noise);
      },
      place.t);
}

double simpson(const auto& function, double from, double to) {
  constexpr int kSteps = 2000;
  const double h = (to - from) / kSteps;
  double sum = function(from) + function(to);
  for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4 : 2) * function(from + h * i);
  return sum * h / 3;
}

// ∫ over D* in [near, d] of f((D − D*)/s)/s e^(−(d − D*)/τ) dD*, by parts, so that F is enough:
// with w = (D − D*)/s from `first` on and Q = F(w) − F(first) it is Q(last) e^(−κ(last − first)) + κ ∫ Q
// e^(−κ(w − first)) dw.
double thickIntegral(const NoiseShape& shape, double first, double last, double kappa) {
  constexpr double kReach = 40;  // beyond this many scales F is 0 or 1
  const double from = std::max(first, -kReach), to = std::min(last, kReach);
  if (!(from < to)) return 0;
  const double decay = std::exp(-kappa * (from - first));
  const double start = shape.cdf(from);
  const auto weighted = [&](double w) { return (shape.cdf(w) - start) * std::exp(-kappa * (w - from)); };
  const double middle = std::clamp(0.0, from, to);  // Laplace's density has a kink there
  const double inner = simpson(weighted, from, middle) + simpson(weighted, middle, to);
  // From `to` on Q is constant, and what lies between `to` and `last` telescopes.
  return decay * (weighted(to) + kappa * inner);
}

double logThickBefore(const SensorModel& sensor, const Measurement& m, const Place& place) {
  const double tau = sensor.prior_decay;
  const double normaliser = tau * -std::expm1(-(place.depth - sensor.near) / tau) / place.range;
  double inliers = 0;
  for (const Hypothesis& h : std::span(m.hypotheses).first(m.count)) {
    inliers += h.share * thickIntegral(sensor.shape, (h.depth - place.depth) / h.noise,
                                       (h.depth - sensor.near) / h.noise, h.noise / tau);
  }
  return std::log((1 - m.outlier) * inliers / normaliser + m.outlier);
}

}  // namespace

double logLikelihoodRatio(const SensorModel& sensor, const Measurement& measurement, double depth) {
  if (sensor.prior_decay <= 0)
    return logVisibleOdds(sensor, measurement, depth) + Place(sensor, depth).logPriorOdds();
  const Place place(sensor, depth);
  return logBehind(sensor, measurement, place) - std::log1p(-place.t) -
         logThickBefore(sensor, measurement, place);
}

double logVisibleOdds(const SensorModel& sensor, const Measurement& measurement, double depth) {
  if (sensor.prior_decay > 0)
    return logLikelihoodRatio(sensor, measurement, depth) - Place(sensor, depth).logPriorOdds();
  const Place place(sensor, depth);
  return logBehind(sensor, measurement, place) - logBefore(sensor, measurement, place);
}

}  // namespace vdbfuse
