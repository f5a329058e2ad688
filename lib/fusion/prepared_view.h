// SPDX-License-Identifier: Apache-2.0
// What every gathering loop needs of a view, made ready once.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <vector>

#include "fusion/noise_curve.h"
#include "vdbfuse/geometry/projector.h"
#include "vdbfuse/sensor/view_windows.h"

namespace vdbfuse {

/// Noise scale of a look-up against depth, tabulated over [near, far]: lookupNoise() to 0.1 %. With an
/// infinite range it is computed each time.
class NoiseTable {
 public:
  static constexpr int kSteps = 512;

  NoiseTable(const SensorModel& sensor, const Projection& projection)
      : near_(static_cast<float>(sensor.near)),
        per_step_(static_cast<float>(kSteps / (sensor.far - sensor.near))),
        sensor_(&sensor),
        projection_(&projection) {
    if (!isTabulated()) return;
    for (int i = 0; i <= kSteps; ++i) {
      const double depth = sensor.near + i * (sensor.far - sensor.near) / kSteps;
      values_[static_cast<std::size_t>(i)] = static_cast<float>(lookupNoise(sensor, projection, depth));
    }
    std::partial_sum(values_.begin(), values_.end(), bounds_.begin(),
                     [](float a, float b) { return std::max(a, b); });
  }
  float at(float depth) const {
    if (!isTabulated()) return static_cast<float>(lookupNoise(*sensor_, *projection_, depth));
    const float place = std::clamp((depth - near_) * per_step_, 0.0f, kSteps - 0.001f);
    const std::size_t i = static_cast<std::size_t>(place);
    return values_[i] + (place - static_cast<float>(i)) * (values_[i + 1] - values_[i]);
  }
  /// No smaller than at() any depth up to this one. REQUIRES: a finite range.
  float boundUpTo(float depth) const {
    const float place = std::clamp((depth - near_) * per_step_, 0.0f, kSteps - 0.001f);
    return bounds_[static_cast<std::size_t>(place) + 1];
  }
  bool isTabulated() const { return per_step_ > 0; }
  const float* values() const { return values_.data(); }
  float near() const { return near_; }
  float perStep() const { return per_step_; }

 private:
  float near_, per_step_;
  const SensorModel* sensor_;
  const Projection* projection_;
  std::array<float, kSteps + 1> values_{}, bounds_{};
};

/// lookupNoise()² without a table: the squares of footprints, whatever the projection, are polynomials of the
/// depth of second degree at most.
struct LookupVariance {
  LookupVariance(const SensorModel& sensor, const Projection& projection) : noise(sensor.noise) {
    const auto slack = [&](double depth) {
      const double whole = lookupNoise(sensor, projection, depth), own = sensor.noise.at(depth);
      return whole * whole - own * own;
    };
    const double none = slack(0), one = slack(1), two = slack(2), curve = 0.5 * (two - 2 * one + none);
    slack0 = static_cast<float>(none), slack1 = static_cast<float>(one - none - curve);
    slack2 = static_cast<float>(curve);
  }

  NoiseCurve noise;
  float slack0, slack1, slack2;
};

/// Says whether no pixel says anything of its whole ray.
inline bool allNothing(const Image<Look>& looks) {
  // Every byte is its neighbour's: the fastest way to look at all of them.
  return looks.empty() || (*looks.data() == Look::Nothing &&
                           std::memcmp(looks.data(), looks.data() + 1, looks.size() - 1) == 0);
}

struct PreparedView {
  PreparedView(const JudgedView& judged, const SensorModel& sensor)
      : view(&judged),
        projector(judged.projection, judged.world_from_camera),
        noise(sensor, judged.projection),
        has_looks(!allNothing(judged.look)),
        has_mask(has_looks &&
                 std::find(judged.look.begin(), judged.look.end(), Look::Outside) != judged.look.end()) {}
  const JudgedView* view;
  Projector projector;
  NoiseTable noise;
  bool has_looks;  ///< some pixel says something of its whole ray
  bool has_mask;   ///< some pixel looks past the object
};

/// visit(depth, share of the inliers) for all that a pixel may have measured. REQUIRES: its depth is valid.
template <class Visit>
void forEachHypothesis(const PreparedView& prepared, std::size_t pixel, const Visit& visit) {
  const JudgedView& view = *prepared.view;
  float left = 1.0f;
  for (const DepthAlternative& alternative : view.alternatives) {
    const float share = alternative.share.data()[pixel];
    if (alternative.depth.data()[pixel] == kInvalidDepth || share <= 0) continue;
    visit(alternative.depth.data()[pixel], share);
    left -= share;
  }
  visit(view.depth.data()[pixel], left);
}

/// Views [begin, end).
inline std::vector<PreparedView> prepare(const JudgedViews& judged, std::size_t begin, std::size_t end) {
  std::vector<PreparedView> prepared;
  prepared.reserve(end - begin);
  for (; begin < end; ++begin) prepared.emplace_back(judged.views[begin], judged.sensor);
  return prepared;
}

/// Calls visit(prepared) for windows of the views, in order; `prepared` holds the views of one window.
template <class Visit>
void forEachPrepared(const JudgedViews& judged, const Visit& visit) {
  forEachWindow(judged.views,
                [&](std::size_t begin, std::size_t end) { visit(prepare(judged, begin, end)); });
}

}  // namespace vdbfuse
