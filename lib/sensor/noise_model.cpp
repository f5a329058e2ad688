// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/noise_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// log(1 − e^x), x ≤ 0, without cancellation at either end (Mächler 2012).
double log1mexp(double x) {
  if (x >= 0) return -kInfinity;
  return x > -std::numbers::ln2 ? std::log(-std::expm1(x)) : std::log1p(-std::exp(x));
}

double logGaussianCdf(double u) {
  if (u > 0) return std::log1p(-0.5 * std::erfc(u / std::numbers::sqrt2));
  if (u > -35) return std::log(0.5 * std::erfc(-u / std::numbers::sqrt2));
  if (u == -kInfinity) return -kInfinity;
  // Mills' ratio; the first term left out is 105/u⁸, below 5e-11.
  const double v = 1 / (u * u);
  return -0.5 * u * u - std::log(-u * std::sqrt(2 * std::numbers::pi)) +
         std::log1p(-v * (1 - v * (3 - 15 * v)));
}

double logLogisticCdf(double u) { return u < 0 ? u - std::log1p(std::exp(u)) : -std::log1p(std::exp(-u)); }

double logLaplaceCdf(double u) { return u < 0 ? u - std::numbers::ln2 : std::log1p(-0.5 * std::exp(-u)); }

template <class Items, class Name>
std::string namesOf(const Items& items, const Name& name) {
  std::string all;
  for (const auto& item : items) all += (all.empty() ? "" : ", ") + name(item);
  return all;
}

}  // namespace

NoiseShape NoiseShape::fromCdf(std::string name, std::function<double(double)> cdf) {
  return {std::move(name), [cdf = std::move(cdf)](double u) { return std::log(cdf(u)); }, {}};
}

double NoiseShape::cdf(double u) const {
  const double below = log_cdf(u);
  return below < -std::numbers::ln2 ? std::exp(below) : -std::expm1(logSurvival(u));
}

double NoiseShape::logBetween(double a, double b) const {
  if (!(a < b)) return -kInfinity;
  // On the side where the tail is thinner: differences of numbers near 1 lose all digits.
  const double low = log_cdf(b), high = logSurvival(a);
  if (low < high) return low + log1mexp(std::min(0.0, log_cdf(a) - low));
  return high + log1mexp(std::min(0.0, logSurvival(b) - high));
}

const NoiseShape& gaussianNoise() {
  static const NoiseShape shape{"gaussian", logGaussianCdf, {}};
  return shape;
}

const NoiseShape& logisticNoise() {
  static const NoiseShape shape{"logistic", logLogisticCdf, {}};
  return shape;
}

const NoiseShape& laplaceNoise() {
  static const NoiseShape shape{"laplace", logLaplaceCdf, {}};
  return shape;
}

const NoiseShape& noiseShape(const std::string& name) {
  for (const NoiseShape* shape : {&gaussianNoise(), &logisticNoise(), &laplaceNoise()})
    if (shape->name == name) return *shape;
  throw InvalidArgument("noise", "'" + name + "' is none of gaussian, logistic, laplace");
}

double NoiseLaw::at(double depth) const {
  if (quadratic > 0 && linear < 0) depth = std::max(depth, -0.5 * linear / quadratic);
  return constant + depth * (linear + depth * quadratic);
}

NoiseLaw NoiseLaw::stereo(double focal_px, double baseline, double matching_error_px) {
  if (!(focal_px > 0)) throw InvalidArgument("focal_px", "must be positive");
  if (!(baseline > 0)) throw InvalidArgument("baseline", "must be positive");
  if (!(matching_error_px > 0)) throw InvalidArgument("matching_error_px", "must be positive");
  return {0, 0, matching_error_px / (focal_px * baseline)};
}

NoiseLaw NoiseLaw::structuredLight(double metre) {
  constexpr double kFloor = 0.0012, kGrowth = 0.0019, kVertex = 0.4;
  return {metre * (kFloor + kGrowth * kVertex * kVertex), -2 * kGrowth * kVertex, kGrowth / metre};
}

NoiseLaw NoiseLaw::timeOfFlight(double metre) { return {0.001 * metre, 0.002, 0}; }

NoiseLaw NoiseLaw::lidar(double metre) { return {0.015 * metre, 0.0001, 0}; }

const std::vector<SensorPreset>& sensorPresets() {
  // The data sheets give a range; these are its middle, one standard deviation.
  static const std::vector<SensorPreset> presets = {
      {"kinect", "Kinect for Xbox 360, Xtion, PrimeSense: structured light", NoiseLaw::structuredLight()},
      {"kinect2", "Kinect for Xbox One, Azure Kinect: time of flight", NoiseLaw::timeOfFlight()},
      {"realsense-d435", "active stereo, 640 pixels of focal length, 50 mm baseline, 0.08 pixels",
       NoiseLaw::stereo(640, 0.05, 0.08)},
      {"lidar", "spinning lidar", NoiseLaw::lidar()},
      {"terrestrial", "terrestrial laser scanner: 2 mm and 0.001 %", {0.002, 0.00001, 0}},
      {"laser", "triangulating laser scanner: 0.1 mm", NoiseLaw::laser(0.0001)},
  };
  return presets;
}

const SensorPreset& sensorPreset(const std::string& name) {
  for (const SensorPreset& preset : sensorPresets())
    if (preset.name == name) return preset;
  throw InvalidArgument("sensor", "'" + name + "' is none of " +
                                      namesOf(sensorPresets(), [](const SensorPreset& p) { return p.name; }));
}

std::vector<std::string> validate(const SensorModel& model) {
  std::vector<std::string> problems;
  if (!(model.far > model.near)) problems.emplace_back("[near, far] must be a range of depths");
  const NoiseLaw& law = model.noise;
  const auto positive_at = [&](double depth) { return !std::isfinite(depth) || law.at(depth) > 0; };
  if (!(positive_at(model.near) && positive_at(model.far)) || law == NoiseLaw{})
    problems.emplace_back("the noise scale must be positive");
  if (!(model.prior_decay >= 0)) problems.emplace_back("prior_decay must not be negative");
  return problems;
}

}  // namespace vdbfuse
