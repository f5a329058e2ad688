// SPDX-License-Identifier: Apache-2.0
// Local planes in a map of inverse depths: a plane in space is a plane there, too.
#pragma once

#include "vdbfuse/geometry/image.h"

namespace vdbfuse::stereo {

struct PlaneFitOptions {
  int radius = 3;         ///< of the square around a pixel, pixels
  float scale = 1;        ///< inverse depth beyond which a pixel belongs to another surface
  float first_scale = 3;  ///< the same while nothing is known of the slant
  int rounds = 3;         ///< of reweighting
};

/// The value at each pixel of the plane through those around it, fitted by least squares, a pixel counting
/// `weight`·(1 + (Δ/scale)²)⁻² for its distance Δ from the plane. Pixels of weight 0 do not count, and become
/// 0.
Image<float> planeFitted(const Image<float>& inverse_depth, const Image<float>& weight,
                         const PlaneFitOptions& options);

}  // namespace vdbfuse::stereo
