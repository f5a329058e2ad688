// SPDX-License-Identifier: Apache-2.0
// Photographs whose depths are known exactly: rectangles and spheres with a smooth texture, seen through
// pinholes.
#pragma once

#include <Eigen/Core>
#include <utility>
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

/// Its texture is that of the plane z = 0, driven through space along (0.6, 0.4, -1).
struct TexturedSphere {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double radius = 0.5;
  int seed = 1;
};
using Spheres = std::vector<TexturedSphere>;

struct TexturedScene {
  // Implicit: most scenes are rectangles alone.
  TexturedScene(Rectangles some_rectangles, Spheres some_spheres = {})
      : rectangles(std::move(some_rectangles)), spheres(std::move(some_spheres)) {}
  Rectangles rectangles;
  Spheres spheres;
};

/// Length of the shortest waves of the texture; it has all from here to 1, with the same amplitude in each
/// octave.
inline constexpr double kFinestWave = 0.08;

/// z of the nearest surface at each pixel; 0: none.
Image<float> trueDepthOf(const TexturedScene& scene, const PhotographHeader& header);

/// brightness = gain·texture + bias, texture in (0, 1); `bias` alone where there is nothing.
Photograph photographOf(const TexturedScene& scene, const PhotographHeader& header, double gain = 1,
                        double bias = 0);

/// One photograph each.
std::vector<Photograph> photographsOf(const TexturedScene& scene,
                                      const std::vector<PhotographHeader>& headers);

/// `count` cameras of 96×72 pixels on an arc around the origin, `step_deg` from one to the next, 2 from it;
/// the middle one looks along +z from (0, 0, −2). A pixel is 0.016 wide at the origin.
std::vector<PhotographHeader> camerasOnArc(int count, double step_deg);

}  // namespace vdbfuse::test
