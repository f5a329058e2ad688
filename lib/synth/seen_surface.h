// SPDX-License-Identifier: Apache-2.0
// What a ray of a synthetic camera meets.
#pragma once

#include <cstdint>
#include <optional>

#include "vdbfuse/mesh/ray_caster.h"
#include "vdbfuse/sensor/view.h"
#include "vdbfuse/synth/scene.h"
#include "vdbfuse/synth/synth_options.h"

namespace vdbfuse::synth {

struct Ray {
  Eigen::Vector3d origin, direction;  ///< direction has z = 1 in the camera: lengths along it are depths
  Eigen::Vector3d at(double depth) const { return origin + depth * direction; }
};

/// The ray of position (x, y) of the view's image.
Ray rayThrough(const ViewHeader& view, double x, double y);

struct SeenPoint {
  double depth = 0;
  std::optional<std::uint32_t> triangle;  ///< of the scene's truth; none: the wall of the background
};

/// The surface of a scene, exact where it has a signed distance, and the wall behind it.
class SeenSurface {
 public:
  /// REQUIRES: `scene` outlives this object.
  SeenSurface(const Scene& scene, Background background);

  /// The first surface that the ray meets.
  std::optional<SeenPoint> see(const Ray& ray) const;
  /// Unit normal of what the ray saw, on the camera's side.
  Eigen::Vector3d normal(const Ray& ray, const SeenPoint& seen) const;

 private:
  const Scene& scene_;
  Background background_;
  RayCaster caster_;
};

}  // namespace vdbfuse::synth
