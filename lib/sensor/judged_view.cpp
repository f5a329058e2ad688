// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/judged_view.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse {
namespace {

Image<Look> lookThrough(const DepthMap& map) {
  Image<Look> look(map.depth.width(), map.depth.height(), Look::Nothing);
  std::transform(map.mask.begin(), map.mask.end(), look.begin(),
                 [](std::uint8_t object) { return object ? Look::Nothing : Look::Outside; });
  return look;
}

}  // namespace

JudgedViews believe(std::vector<View> views, const SensorModel& sensor, double outlier) {
  JudgedViews result;
  result.sensor = sensor;
  for (View& view : views) {
    JudgedView judged;
    static_cast<ViewHeader&>(judged) = std::move(static_cast<ViewHeader&>(view));
    applyMask(view.map);
    judged.look = lookThrough(view.map);
    judged.depth = std::move(view.map.depth);
    judged.alternatives = std::move(view.map.alternatives);
    judged.outlier = Image<float>(judged.depth.width(), judged.depth.height(), static_cast<float>(outlier));
    judged.incidence = Image<float>(judged.depth.width(), judged.depth.height());
    result.views.push_back(std::move(judged));
  }
  return result;
}

double lookupNoise(const SensorModel& sensor, const Projection& projection, double depth) {
  constexpr double kSlackPixels = 0.4;
  return std::hypot(sensor.noise.at(depth), kSlackPixels * footprint(projection, depth));
}

}  // namespace vdbfuse
