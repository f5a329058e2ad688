// SPDX-License-Identifier: Apache-2.0
#include "fusion/likelihood_ratio.h"

namespace vdbfuse {
namespace {

// κ = s/τ of the rows: beyond the last one a wall is thinner than the noise, before the first one the prior
// is flat.
constexpr double kFirstDecay = 1e-4, kLastDecay = 4.0;

constexpr float kNothing = 1e-8f;

double decayOf(int row, int rows) {
  return kFirstDecay * std::pow(kLastDecay / kFirstDecay, row / (rows - 1.0));
}

// H' = f − κ H, step by step, exact for an f that is constant within a step.
std::vector<float> decayedCdf(const std::vector<float>& cdf, double kappa, double step) {
  std::vector<float> result(cdf.size());
  double value = cdf.front();
  result.front() = static_cast<float>(value);
  const double decay = std::exp(-kappa * step), gain = -std::expm1(-kappa * step) / (kappa * step);
  for (std::size_t i = 1; i < cdf.size(); ++i) {
    value = value * decay + gain * static_cast<double>(cdf[i] - cdf[i - 1]);
    result[i] = static_cast<float>(value);
  }
  return result;
}

}  // namespace

LikelihoodRatio::LikelihoodRatio(const SensorModel& sensor)
    : near_(static_cast<float>(sensor.near)),
      far_(static_cast<float>(sensor.far)),
      per_range_(static_cast<float>(1.0 / (sensor.far - sensor.near))),
      first_(near_ + kEnd * (far_ - near_)),
      last_(near_ + (1 - kEnd) * (far_ - near_)),
      prior_decay_(static_cast<float>(sensor.prior_decay)) {
  // F here is of (D* − D)/s, the mirror image of the shape's.
  for (int i = 0; i <= kSteps + 1; ++i)
    cdf_.push_back(
        static_cast<float>(std::exp(sensor.shape.logSurvival(kReach - 2.0 * i / kSteps * kReach))));
  const auto felt = std::find_if(cdf_.begin(), cdf_.end(), [](float f) { return f > kNothing; });
  reach_ = kReach - 2 * kReach / kSteps * static_cast<float>(felt - cdf_.begin());
  if (!thick()) return;
  for (int row = 0; row < kDecays; ++row)
    decayed_.push_back(decayedCdf(cdf_, decayOf(row, kDecays), 2 * static_cast<double>(kReach) / kSteps));
}

float LikelihoodRatio::decayed(float u, float kappa) const {
  const double k_exact = std::clamp<double>(kappa, kFirstDecay, kLastDecay);
  const double row = std::log(k_exact / kFirstDecay) / std::log(kLastDecay / kFirstDecay) * (kDecays - 1);
  const std::size_t k = static_cast<std::size_t>(std::min(row, kDecays - 1.000001));
  const double low = decayOf(static_cast<int>(k), kDecays), high = decayOf(static_cast<int>(k) + 1, kDecays);
  const float g = static_cast<float>((k_exact - low) / (high - low));
  const float place = (std::clamp(u, -kReach, kReach) + kReach) * (kSteps / (2 * kReach));
  const std::size_t i = static_cast<std::size_t>(place);
  const float f = place - static_cast<float>(i);
  const auto at = [&](std::size_t line) {
    return decayed_[line][i] + f * (decayed_[line][i + 1] - decayed_[line][i]);
  };
  // Exponential in κ behind the measurement.
  const float first = std::max(at(k), 1e-30f), second = std::max(at(k + 1), 1e-30f);
  const float inside = first * std::pow(second / first, g);
  return u > kReach ? inside * std::exp(-kappa * (u - kReach)) : inside;
}

float LikelihoodRatio::thick(const Peak& peak, float depth) const {
  const float kappa = peak.noise / prior_decay_;
  const float u = (depth - peak.depth) / peak.noise, first = (near_ - peak.depth) / peak.noise;
  const float integral = decayed(u, kappa) - std::exp(-kappa * (u - first)) * decayed(first, kappa);
  const float normaliser = prior_decay_ * -std::expm1(-(depth - near_) / prior_decay_) * per_range_;
  return std::max(integral, 0.0f) / normaliser;
}

}  // namespace vdbfuse
