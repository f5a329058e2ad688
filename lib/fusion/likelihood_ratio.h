// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "vdbfuse/sensor/noise_model.h"

namespace vdbfuse {

/// logLikelihoodRatio() for many points: F from a table, to 1e-6.
class LikelihoodRatio {
 public:
  explicit LikelihoodRatio(const SensorModel& sensor)
      : near_(static_cast<float>(sensor.near)),
        far_(static_cast<float>(sensor.far)),
        per_range_(static_cast<float>(1.0 / (sensor.far - sensor.near))) {
    for (int i = 0; i <= kSteps + 1; ++i) {
      cdf_.push_back(static_cast<float>(noiseCdf(sensor.shape, (2.0 * i / kSteps - 1.0) * kReach)));
    }
  }

  float log(float measured, float noise, float outlier, float depth) const {
    const float per_noise = 1.0f / noise;
    const float t = std::clamp((depth - near_) * per_range_, 0.001f, 0.999f);
    const float before = cdf((depth - measured) * per_noise);
    const float first = cdf((near_ - measured) * per_noise), last = cdf((far_ - measured) * per_noise);
    const float a = ((1 - outlier) * std::max(last - before, 0.0f) + outlier * (1 - t)) / (1 - t);
    const float b = ((1 - outlier) * std::max(before - first, 0.0f) + outlier * t) / t;
    return std::log(a / b);
  }

 private:
  static constexpr int kSteps = 8192;
  static constexpr float kReach = 16.0f;  // beyond this many scales F is 0 or 1

  float cdf(float u) const {
    const float place = (std::clamp(u, -kReach, kReach) + kReach) * (kSteps / (2 * kReach));
    const std::size_t i = static_cast<std::size_t>(place);
    return cdf_[i] + (place - static_cast<float>(i)) * (cdf_[i + 1] - cdf_[i]);
  }

  float near_, far_, per_range_;
  std::vector<float> cdf_;
};

}  // namespace vdbfuse
