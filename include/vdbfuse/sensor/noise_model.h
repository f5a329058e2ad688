// SPDX-License-Identifier: Apache-2.0
// What a sensor's depths are worth: p(D | D*) = (1 − ε) f((D − D*)/s(D))/s(D) + ε/R  (Hernández et al. 2007,
// sec. 3.3).
#pragma once

#include <string>
#include <vector>

namespace vdbfuse {

/// Shape of the noise of inliers: its cumulative distribution and nothing more. Scale 1: the standard
/// deviation of the Gaussian, the w of the logistic F(u) = 1/(1 + e^−u), the b of the Laplace distribution.
enum class NoiseShape { Gaussian, Logistic, Laplace };

/// F(u), in [0, 1]. Accurate to a few ulp of the smaller of F(u) and F(−u).
double noiseCdf(NoiseShape shape, double u);

/// How the scale grows with depth: s(z) = constant + linear·z + quadratic·z², in the unit of the poses.
/// Laser: constant; lidar: linear; stereo: quadratic = s_px/(f·b).
struct NoiseLaw {
  double constant = 0.0;
  double linear = 0.0;
  double quadratic = 0.0;
  double at(double depth) const { return constant + depth * (linear + depth * quadratic); }
  NoiseLaw operator*(double factor) const { return {constant * factor, linear * factor, quadratic * factor}; }
  bool operator==(const NoiseLaw&) const = default;
};

/// Everything evidence needs to know of the sensor that is not a property of one pixel.
struct SensorModel {
  NoiseShape shape = NoiseShape::Gaussian;
  NoiseLaw noise;
  /// What the sensor could have measured: outliers are uniform in [near, far].
  double near = 0.0;
  double far = 0.0;
};

/// Everything that is wrong with a model, one sentence each.
std::vector<std::string> validate(const SensorModel& model);

}  // namespace vdbfuse
