// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/geometry/rigid_transform.h"

namespace vdbfuse {

/// world_from_camera of a camera at `eye` whose z axis points at `target` and whose image shows `up` upwards.
/// Where `up` is parallel to the line of sight, the coordinate axis furthest from it takes its place.
/// REQUIRES: eye ≠ target, up ≠ 0.
RigidTransform lookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Eigen::Vector3d& up);

/// Where the viewer of a front view stands, when `up` points up: −y for +z, as in CAD drawings, +z for +y, as
/// in computer graphics; turned along for other directions. A unit vector at right angles to `up`. REQUIRES:
/// up ≠ 0.
Eigen::Vector3d frontFor(const Eigen::Vector3d& up);

}  // namespace vdbfuse
