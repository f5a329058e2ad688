// SPDX-License-Identifier: Apache-2.0
// The scenes that are defined by a signed distance, each in units of its own.
#pragma once

#include <optional>

#include "vdbfuse/synth/scene.h"

namespace vdbfuse::synth {

struct Shape {
  SignedDistance distance;
  Box bounds;  ///< exact
  std::vector<SceneRegion> regions;
};

/// Nothing for a name that is not one of sceneNames().
std::optional<Shape> shapeNamed(const std::string& name);

/// Signed distance to a box, > 0 outside.
double boxDistance(const Eigen::Vector3d& point, const Eigen::Vector3d& center,
                   const Eigen::Vector3d& half_size);

}  // namespace vdbfuse::synth
