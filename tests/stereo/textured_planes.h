// SPDX-License-Identifier: Apache-2.0
// Photographs whose depths are known exactly: rectangles with a smooth texture, seen through pinholes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse::test {

/// The points origin + s·u + t·v with |s| <= half_u, |t| <= half_v.
struct TexturedRectangle {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = Eigen::Vector3d::UnitY();  ///< unit, at right angles
  double half_u = 1, half_v = 1;
  int seed = 1;  ///< of the texture: the same one for the same seed
};
using Rectangles = std::vector<TexturedRectangle>;

/// Length of the shortest waves of the texture; it has all from here to 1, with the same amplitude in each
/// octave.
inline constexpr double kFinestWave = 0.08;

/// z of the nearest rectangle at each pixel; 0: none.
Image<float> depthOfRectangles(const Rectangles& rectangles, const PhotographHeader& header);

/// brightness = gain·texture + bias, texture in (0, 1); `bias` alone where there is nothing.
Photograph photographOfRectangles(const Rectangles& rectangles, const PhotographHeader& header,
                                  double gain = 1, double bias = 0);

/// `count` cameras of 96×72 pixels on an arc around the origin, `step_deg` from one to the next, 2 from it;
/// the middle one looks along +z from (0, 0, −2). A pixel is 0.016 wide at the origin.
std::vector<PhotographHeader> camerasOnArc(int count, double step_deg);

}  // namespace vdbfuse::test
