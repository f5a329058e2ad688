// SPDX-License-Identifier: Apache-2.0
// What one measurement says of one point on its ray (Hernández et al. 2007, sections 3.3 and 4): exact, in
// the log domain, from ε = 0 and a million noise scales away. The grids use tables of it
// (lib/fusion/likelihood_ratio.h).
#pragma once

#include <array>
#include <cstddef>

#include "vdbfuse/sensor/noise_model.h"

namespace vdbfuse {

/// A depth that a pixel may have measured.
struct Hypothesis {
  double depth = 0;  ///< D, in the sensor's own measure
  double noise = 0;  ///< s(D) > 0
  double share = 1;  ///< of the inliers
};

/// What a pixel measured: the inlier is one of up to four hypotheses, whose shares add up to 1.
struct Measurement {
  static constexpr std::size_t kMaxHypotheses = 4;
  std::array<Hypothesis, kMaxHypotheses> hypotheses;
  std::size_t count = 1;
  double outlier = 0;  ///< ε in [0, 1): probability that the surface is at none of them

  Measurement(double depth, double noise, double outlier_probability)
      : hypotheses{Hypothesis{depth, noise, 1.0}}, outlier(outlier_probability) {}
};

/// log L = log p(D | the sensor sees past d) / p(D | it does not), for D* uniform on either side of d in
/// [near, far]:
///   A = [(1−ε)(F((far−D)/s) − F((d−D)/s)) + ε(1−t)]/(1−t),  B = [(1−ε)(F((d−D)/s) − F((near−D)/s)) + ε t]/t,
///   t = (d − near)/(far − near), kept within [0.001, 0.999] together with d;  L = A/B.
/// With sensor.prior_decay = τ > 0, B has D* ~ exp(−(d − D*)/τ) on [near, d] in place of the uniform one.
/// With an infinite range t/(1 − t) has no meaning and is left out (Curless–Levoy); ε must then be 0.
double logLikelihoodRatio(const SensorModel& sensor, const Measurement& measurement, double depth);

/// log((1 − π)/π), π = p(the sensor does not see past d | D), equation (6): the posterior odds, that is
/// log L + log((1 − t)/t). With a flat prior, logistic noise, ε = 0 and an infinite range it is (D − d)/s.
double logVisibleOdds(const SensorModel& sensor, const Measurement& measurement, double depth);

}  // namespace vdbfuse
