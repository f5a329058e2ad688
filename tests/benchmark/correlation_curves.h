// SPDX-License-Identifier: Apache-2.0
// The correlation curves of single pixels, without any haste: what the mean of the curves makes of them, and
// what votes do (Hernández et al. 2007, sec. 3.1).
#pragma once

#include <vector>

#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse::benchmark {

struct CurveDepths {
  double mean = 0;   ///< where the mean of the curves is largest
  double voted = 0;  ///< where the votes of their maxima are
};

/// Depths of pixel (x, y), 0 where there is none: normalised cross-correlation of the 7×7 window, parallel to
/// the picture, at inverse depths half a pixel apart in the partner in whose picture the point moves most.
CurveDepths depthsFromCurves(const Photograph& reference, const std::vector<Photograph>& partners, int x,
                             int y);

}  // namespace vdbfuse::benchmark
