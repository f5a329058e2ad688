// SPDX-License-Identifier: Apache-2.0
// A depth map and the sensor that took it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// The one representation of "nothing measured here". Valid depths are finite and > 0.
inline constexpr float kInvalidDepth = 0.0f;

/// Depth in the sensor's own measure (see geometry/projection.h), in the unit of the poses.
struct DepthMap {
  Image<float> depth;
  /// Any scale, either direction; same size as `depth`; empty when there is none. Non-finite: unknown.
  Image<float> confidence;
  /// Same size as `depth` or of a size of its own; empty when there is none.
  Image<Rgb8> color;
};

/// Turns every non-finite, zero or negative depth into kInvalidDepth. Readers call it once.
void normaliseInvalid(Image<float>& depth);

/// What is known of a view before its images are loaded.
struct ViewHeader {
  std::string name;
  Projection projection;
  RigidTransform world_from_camera = RigidTransform::Identity();
};

/// A view with its images in memory.
struct View : ViewHeader {
  DepthMap map;
};

/// The world point of pixel (x, y). REQUIRES: the pixel is valid.
Eigen::Vector3d worldPoint(const View& view, int x, int y);

/// Everything that is wrong with a view, one sentence each: projection, pose, image sizes.
std::vector<std::string> validate(const View& view);

}  // namespace vdbfuse
