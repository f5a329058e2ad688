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

}  // namespace

double logLikelihoodRatio(const SensorModel& sensor, const Measurement& measurement, double depth) {
  return logVisibleOdds(sensor, measurement, depth) + Place(sensor, depth).logPriorOdds();
}

double logVisibleOdds(const SensorModel& sensor, const Measurement& measurement, double depth) {
  const Place place(sensor, depth);
  return logBehind(sensor, measurement, place) - logBefore(sensor, measurement, place);
}

}  // namespace vdbfuse
