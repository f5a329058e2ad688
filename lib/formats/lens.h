// SPDX-License-Identifier: Apache-2.0
// Photographs through a lens made into photographs through a pinhole.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse {

struct Lens {
  Pinhole camera;  ///< with Brown–Conrady distortion, which leads from the ideal ray to the picture's
  /// VisualSFM's, which leads the other way: ideal ray = (1 + k·r²)·ray of the picture, r the latter's
  /// length. One of the two is 0.
  double measured_radial = 0;
  bool operator==(const Lens&) const = default;
};

bool isDistorted(const Lens& lens);

/// Where the picture shows what lies in the direction of the ray (x/z, y/z); nothing beyond where the model
/// folds back. May lie outside.
std::optional<Eigen::Vector2d> pixelOf(const Lens& lens, const Eigen::Vector2d& ray);

/// The pinhole without distortion to whose pixels the picture is brought: the same size and principal point,
/// and focal lengths times the least factor in [1, 1.5] for which all of them lie in the picture.
Pinhole withoutDistortion(const Lens& lens);

/// Brings brightness, colour and mask from the pixels of the lens to those of photograph.camera, which is
/// withoutDistortion(lens): bilinear, the mask by the nearest pixel. What lies outside the picture is black
/// and 0 in the mask, which is made where there was none.
void undistort(Photograph& photograph, const Lens& lens);

}  // namespace vdbfuse
