// SPDX-License-Identifier: Apache-2.0
// A depth map and the sensor that took it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// The one representation of "nothing measured here". Valid depths are finite and > 0.
inline constexpr float kInvalidDepth = 0.0f;

/// A second, third or fourth depth that a pixel may have measured (Hernández et al. 2007, sec. 3.1: the other
/// maxima of a correlation curve).
struct DepthAlternative {
  Image<float> depth;  ///< kInvalidDepth where there is none
  Image<float> share;  ///< probability that this one is right rather than the others, in [0, 1)
};

/// Depth in the sensor's own measure (see geometry/projection.h), in the unit of the poses.
struct DepthMap {
  Image<float> depth;
  /// Any scale, either direction; same size as `depth`; empty when there is none. Non-finite: unknown.
  Image<float> confidence;
  /// Same size as `depth` or of a size of its own; empty when there is none.
  Image<Rgb8> color;
  /// Up to three, of the size of `depth`; `depth` itself has the share that they leave.
  std::vector<DepthAlternative> alternatives;
  /// Silhouette of the object: non-zero where the pixel sees it. Same size as `depth`; empty when there is
  /// none. What is measured outside it is background: ViewSequence::load() makes it invalid.
  Image<std::uint8_t> mask;
};

/// Whether the pixel looks past the object, whatever it measured.
inline bool isOutsideMask(const DepthMap& map, int x, int y) { return !map.mask.empty() && !map.mask(x, y); }

/// Makes every depth outside the mask invalid. REQUIRES: the mask is empty or of the depth's size.
void applyMask(DepthMap& map);

/// Turns every non-finite, zero or negative depth into kInvalidDepth. Readers call it once.
void normaliseInvalid(Image<float>& depth);

/// The camera of a picture that the depth sensor did not take itself.
struct ColorSensor {
  Projection projection;
  RigidTransform world_from_camera = RigidTransform::Identity();
};

/// What is known of a view before its images are loaded.
struct ViewHeader {
  std::string name;
  Projection projection;
  RigidTransform world_from_camera = RigidTransform::Identity();
  /// Of DepthMap::color; none: the picture was taken by the depth sensor, or brought to its pixels.
  std::optional<ColorSensor> color_sensor = std::nullopt;
};

/// A view with its images in memory.
struct View : ViewHeader {
  DepthMap map;
  /// Where its images lie, and where others about it should.
  std::pmr::memory_resource* memory() const { return map.depth.memory(); }
};

/// The world point of pixel (x, y). REQUIRES: the pixel is valid.
Eigen::Vector3d worldPoint(const View& view, int x, int y);

/// Everything that is wrong with a view, one sentence each: projection, pose, image sizes.
std::vector<std::string> validate(const View& view);

}  // namespace vdbfuse
