// SPDX-License-Identifier: Apache-2.0
// The surface around each pixel of one depth map: its normal, and how much of the neighbourhood continues it.
#pragma once

#include "vdbfuse/sensor/noise_model.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

struct PixelSurface {
  /// Unit normal in world coordinates, towards the sensor; zero where there is none.
  Image<Eigen::Vector3f> normal;
  /// Cosine between normal and optic ray; 0 where there is no normal.
  Image<float> incidence;
  /// Share of the measured pixels of the 5×5 neighbourhood that continue the same surface, in [0, 1]: holes
  /// do not count against a sparse sensor. Fewer than six measured neighbours count as six. 0 at invalid
  /// pixels.
  Image<float> continuity;
};

/// A neighbour continues the surface when its depth differs by no more than 3√2 s plus what a slope of 70°
/// explains. Normals: least-squares plane in 1/d over the continuing neighbours, six at least.
PixelSurface analyseSurface(const View& view, const NoiseLaw& noise);

/// The normal of one pixel of it.
Eigen::Vector3f surfaceNormal(const View& view, const NoiseLaw& noise, int x, int y);

}  // namespace vdbfuse
