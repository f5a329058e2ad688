// SPDX-License-Identifier: Apache-2.0
// What every gathering loop needs of a view, made ready once.
#pragma once

#include <array>
#include <vector>

#include "vdbfuse/geometry/projector.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Noise scale of a look-up against depth, tabulated over [near, far]: lookupNoise() to 0.1 %.
class NoiseTable {
 public:
  NoiseTable(const SensorModel& sensor, const Projection& projection)
      : near_(sensor.near), per_step_(kSteps / (sensor.far - sensor.near)) {
    for (int i = 0; i <= kSteps; ++i) {
      values_[static_cast<std::size_t>(i)] =
          static_cast<float>(lookupNoise(sensor, projection, near_ + i / per_step_));
    }
  }
  float at(float depth) const {
    const double place = std::clamp((depth - near_) * per_step_, 0.0, kSteps - 1e-9);
    const std::size_t i = static_cast<std::size_t>(place);
    const float f = static_cast<float>(place - static_cast<double>(i));
    return values_[i] + f * (values_[i + 1] - values_[i]);
  }

 private:
  static constexpr int kSteps = 512;
  double near_, per_step_;
  std::array<float, kSteps + 1> values_{};
};

struct PreparedView {
  PreparedView(const JudgedView& judged, const SensorModel& sensor)
      : view(&judged),
        projector(judged.projection, judged.world_from_camera),
        noise(sensor, judged.projection) {}
  const JudgedView* view;
  Projector projector;
  NoiseTable noise;
};

inline std::vector<PreparedView> prepare(const JudgedViews& judged) {
  std::vector<PreparedView> prepared;
  prepared.reserve(judged.views.size());
  for (const JudgedView& view : judged.views) prepared.emplace_back(view, judged.sensor);
  return prepared;
}

}  // namespace vdbfuse
