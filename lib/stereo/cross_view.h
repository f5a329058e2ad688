// SPDX-License-Identifier: Apache-2.0
// What other views' depth maps say of a pixel of this one.
#pragma once

#include "stereo/surface.h"
#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse::stereo {

/// The depths of a view.
struct SeenDepths {
  const DepthLayer* layer = nullptr;
  Pinhole camera;
  RigidTransform world_from_camera = RigidTransform::Identity();
  float full_score = 1;  ///< of complete agreement: the number of its partners
};

/// One view's depths as another view sees them: the nearest surface at each pixel.
struct Testimony {
  Image<float> inverse_depth;  ///< 0: nothing
  Image<float> weight;         ///< in [0, 1]: confidence
  /// Middle of what landed at a pixel, from the pixel's own, in pixels: where inverse_depth holds.
  Image<float> off_x, off_y;
};

/// Moves every pixel of `from` to where `camera` sees it and spreads it over the four pixels around; what
/// lies more than `tolerance` of inverse depth behind the nearest one is hidden.
Testimony seenFrom(const SeenDepths& from, const Pinhole& camera, const RigidTransform& world_from_camera,
                   float tolerance);

}  // namespace vdbfuse::stereo
