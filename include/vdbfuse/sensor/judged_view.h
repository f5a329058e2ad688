// SPDX-License-Identifier: Apache-2.0
// A view with what is known about the reliability of each of its pixels: the input of everything that fuses.
#pragma once

#include <vector>

#include "vdbfuse/sensor/noise_model.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// Probabilities are kept away from 0 and 1, so that no single pixel can outvote all others.
inline constexpr float kMinOutlier = 0.003f;
inline constexpr float kMaxOutlier = 0.99f;

/// What a pixel says of its whole ray, beside its depth or in place of one.
enum class Look : std::uint8_t {
  Nothing,
  Empty,    ///< nothing came back, for a reason that means empty space
  Outside,  ///< outside the silhouette mask: the ray meets no part of the object
};

struct JudgedView : ViewHeader {
  Image<float> depth;
  /// ε of each pixel: probability that its depth has nothing to do with the surface. Same size as `depth`.
  Image<float> outlier;
  /// Other depths of the same pixels. ε is the probability that none of them all is right.
  std::vector<DepthAlternative> alternatives;
  /// Cosine between the optic ray and the surface normal; 0 where the normal is not known. Same size as
  /// `depth`.
  Image<float> incidence;
  /// Empty counts only where the depth is missing; where it says Outside the depth does not count. Same size
  /// as `depth`.
  Image<Look> look;
  /// w_i in (0, 1]: how much of this view is not a repetition of its neighbours.
  double weight = 1.0;
  std::pmr::memory_resource* memory() const { return depth.memory(); }
};

/// Views judged, and the model of the sensor that all of them share.
struct JudgedViews {
  std::vector<JudgedView> views;
  SensorModel sensor;
  /// Share of no-returns where a confirmed point should have been seen.
  double miss_rate = 0.5;
};

/// Views that are believed as they are: every valid pixel has outlier probability `outlier`, and the masks
/// say where to look past the object. `incidence`: of each view, where it is known.
JudgedViews believe(std::vector<View> views, const SensorModel& sensor, double outlier = kMinOutlier,
                    std::vector<Image<float>> incidence = {});

/// Noise scale of a measurement that is looked up at the nearest pixel: sensor noise plus the slack of a
/// slanted surface, about 0.4 pixel footprints.
double lookupNoise(const SensorModel& sensor, const Projection& projection, double depth);

}  // namespace vdbfuse
