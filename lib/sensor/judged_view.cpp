// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/judged_view.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {
namespace {

Image<Look> lookThrough(const DepthMap& map) {
  Image<Look> look(map.depth.width(), map.depth.height(), Look::Nothing, map.depth.memory());
  std::transform(map.mask.begin(), map.mask.end(), look.begin(),
                 [](std::uint8_t object) { return object ? Look::Nothing : Look::Outside; });
  return look;
}

}  // namespace

JudgedViews believe(std::vector<View> views, const SensorModel& sensor, double outlier,
                    std::vector<Image<float>> incidence) {
  JudgedViews result;
  result.sensor = sensor;
  incidence.resize(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    View& view = views[i];
    JudgedView judged;
    static_cast<ViewHeader&>(judged) = std::move(static_cast<ViewHeader&>(view));
    applyMask(view.map);
    judged.look = lookThrough(view.map);
    judged.depth = std::move(view.map.depth);
    judged.alternatives = std::move(view.map.alternatives);
    const int width = judged.depth.width(), height = judged.depth.height();
    judged.outlier = Image<float>(width, height, static_cast<float>(outlier), judged.memory());
    judged.incidence = std::move(incidence[i]);
    if (judged.incidence.empty()) judged.incidence = Image<float>(width, height, 0.0f, judged.memory());
    view.map = {};
    letGo(judged);
    result.views.push_back(std::move(judged));
  }
  return result;
}

double lookupNoise(const SensorModel& sensor, const Projection& projection, double depth) {
  constexpr double kSlackPixels = 0.4;
  return std::hypot(sensor.noise.at(depth), kSlackPixels * footprint(projection, depth));
}

}  // namespace vdbfuse
