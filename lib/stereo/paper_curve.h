// SPDX-License-Identifier: Apache-2.0
// Mode `paper`: the curve S_j(d), normalised cross-correlation of the window of a pixel with its image in
// partner j, d along the optic ray. Changes of a photograph's brightness by gain and bias change nothing.
#pragma once

#include <optional>
#include <vector>

#include "stereo/paper_ray.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse::stereo::paper {

/// The square of pixels around one, brightness less its mean, divided by its norm.
struct Window {
  int x = 0, y = 0, radius = 0;
  std::vector<double> values;  ///< row by row
};

/// Nothing where the window leaves the photograph or its mask, or has a standard deviation below
/// kLeastDeviation.
std::optional<Window> windowAt(const Photograph& photograph, int x, int y, int radius);

/// Where there is no score: the image of the window leaves the partner's picture or mask, or has no texture.
inline constexpr double kNoScore = -2;

/// Score in [−1, 1] or kNoScore at each step. Each pixel of the window is taken to lie at the depth of the
/// middle one (the window faces the reference) and looked up in the partner between pixels, bilinearly.
std::vector<double> correlationCurve(const Window& window, const Photograph& partner, const RayImage& ray,
                                     const RaySteps& steps);

}  // namespace vdbfuse::stereo::paper
