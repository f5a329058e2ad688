// SPDX-License-Identifier: Apache-2.0
// What a sensor's depths are worth: p(D | D*) = (1 − ε) f((D − D*)/s(D))/s(D) + ε/R  (Hernández et al. 2007,
// sec. 3.3).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace vdbfuse {

/// Shape of the noise of inliers in units of its scale: its cumulative distribution F of (D − D*)/s and
/// nothing more. A model of your own is one call of fromCdf(), or, exact far into the tails, both logarithms.
struct NoiseShape {
  std::string name;
  std::function<double(double)> log_cdf;       ///< log F(u); −∞ allowed
  std::function<double(double)> log_survival;  ///< log(1 − F(u)); empty: symmetric, log F(−u)

  /// From F alone, symmetric about 0. Beyond the smallest double F is 0: give log_cdf where ε = 0.
  static NoiseShape fromCdf(std::string name, std::function<double(double)> cdf);

  /// F(u), accurate to a few ulp of the smaller of F(u) and 1 − F(u).
  double cdf(double u) const;
  double logCdf(double u) const { return log_cdf(u); }
  double logSurvival(double u) const { return log_survival ? log_survival(u) : log_cdf(-u); }
  /// log(F(b) − F(a)) without cancellation in either tail; a, b may be infinite. −∞ unless a < b.
  double logBetween(double a, double b) const;
};

/// Scale: the standard deviation. The paper's default.
const NoiseShape& gaussianNoise();
/// F(u) = 1/(1 + e^−u): the noise that makes Curless–Levoy fusion a member (sec. 4.1).
const NoiseShape& logisticNoise();
/// Density ½ e^−|u|.
const NoiseShape& laplaceNoise();
/// By name: gaussian, logistic, laplace. Throws InvalidArgument that lists them.
const NoiseShape& noiseShape(const std::string& name);

/// How the scale grows with depth: s(z) = constant + linear·z + quadratic·z², in the unit of the poses; not
/// below `constant + linear·z + quadratic·z²` at the vertex of a parabola that has one (structured light).
struct NoiseLaw {
  double constant = 0.0;
  double linear = 0.0;
  double quadratic = 0.0;
  double at(double depth) const;
  NoiseLaw operator*(double factor) const { return {constant * factor, linear * factor, quadratic * factor}; }
  bool operator==(const NoiseLaw&) const = default;

  /// Triangulation by a rig of focal length f (pixels) and baseline b: s = z² · matching error/(f b).
  static NoiseLaw stereo(double focal_px, double baseline, double matching_error_px);
  /// Structured light: 1.2 mm + 1.9 mm (z/m − 0.4)², axial noise of the first Kinect (Nguyen, Izadi, Lovell
  /// 2012). `metre`: one metre in the unit of the poses.
  static NoiseLaw structuredLight(double metre = 1.0);
  /// Time of flight: 1 mm + 0.2 % of the distance, from jitter of the phase.
  static NoiseLaw timeOfFlight(double metre = 1.0);
  /// Spinning lidar: 15 mm whatever the distance, and 0.01 % of it.
  static NoiseLaw lidar(double metre = 1.0);
  /// Triangulating laser scanner: the same everywhere.
  static NoiseLaw laser(double scale) { return {scale, 0, 0}; }
};

/// A sensor as its makers and users describe it, in metres.
struct SensorPreset {
  std::string name;
  std::string about;
  NoiseLaw noise;
};

/// kinect, kinect2, realsense-d435, lidar, terrestrial, laser: starting points where views do not overlap
/// enough to calibrate; sources in the .cpp.
const std::vector<SensorPreset>& sensorPresets();
/// Throws InvalidArgument that lists the names.
const SensorPreset& sensorPreset(const std::string& name);

/// Everything evidence needs to know of the sensor that is not a property of one pixel.
struct SensorModel {
  NoiseShape shape = gaussianNoise();
  NoiseLaw noise;
  /// What the sensor could have measured: outliers are uniform in [near, far]. May be infinite where no pixel
  /// is an outlier.
  double near = 0.0;
  double far = 0.0;
  /// τ of the depth prior p(D* | x inside) ∝ exp(−(d − D*)/τ): far behind a surface there is less and less
  /// reason to be inside. Length; 0: flat.
  double prior_decay = 0.0;
};

/// Everything that is wrong with a model, one sentence each.
std::vector<std::string> validate(const SensorModel& model);

}  // namespace vdbfuse
