// SPDX-License-Identifier: Apache-2.0
// Mode `paper`: the optic ray of a pixel, its image in a partner, and the depths at which it is sampled.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse::stereo::paper {

/// Where a partner sees the points of the optic rays o(d) (Hernández et al. 2007, eq. (2)) of the reference.
struct RayImage {
  Eigen::Matrix3d a;  ///< K_j R K_i⁻¹
  Eigen::Vector3d b;  ///< K_j t

  /// The point of pixel (x, y) at inverse depth w, homogeneous: a·(x, y, 1) + w·b. Behind the partner where
  /// the last coordinate is not above 0.
  Eigen::Vector3d at(double x, double y, double w) const { return a * Eigen::Vector3d(x, y, 1) + w * b; }
};

RayImage rayImage(const PhotographHeader& reference, const PhotographHeader& partner);

/// Depths z equally spaced in inverse depth, the far end first.
struct RaySteps {
  double first = 0, step = 0;  ///< inverse depths
  int count = 0;
  double inverseDepth(double k) const { return first + k * step; }
};

/// Steps over the whole interval, so small that from one to the next no partner's image of a pixel moves by
/// more than `step_px`: the partner with the widest baseline decides. At least three.
RaySteps raySteps(const PhotographHeader& reference, const std::vector<PhotographHeader>& partners,
                  const DepthInterval& depths, double step_px);

}  // namespace vdbfuse::stereo::paper
