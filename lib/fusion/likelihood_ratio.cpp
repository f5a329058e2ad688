// SPDX-License-Identifier: Apache-2.0
#include "fusion/likelihood_ratio.h"

namespace vdbfuse {
LikelihoodRatio::LikelihoodRatio(const SensorModel& sensor)
    : near_(static_cast<float>(sensor.near)),
      far_(static_cast<float>(sensor.far)),
      per_range_(static_cast<float>(1.0 / (sensor.far - sensor.near))),
      first_(near_ + kEnd * (far_ - near_)),
      last_(near_ + (1 - kEnd) * (far_ - near_)) {
  // F here is of (D* − D)/s, the mirror image of the shape's.
  for (int i = 0; i <= kSteps + 1; ++i)
    cdf_.push_back(
        static_cast<float>(std::exp(sensor.shape.logSurvival(kReach - 2.0 * i / kSteps * kReach))));
}

}  // namespace vdbfuse
