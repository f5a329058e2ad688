// SPDX-License-Identifier: Apache-2.0
// Scans that know the row and column of each point, in whatever order the scanner counted them.
#pragma once

#include <Eigen/Core>

#include "vdbfuse/sensor/organised_points.h"

namespace vdbfuse {

/// Coordinates beyond this are not a measurement.
inline constexpr double kFarthestPoint = 1e30;

/// `point` in single precision; NaN when it is not finite, absurdly far away, or the origin: "no return".
Eigen::Vector3f scannedPoint(const Eigen::Vector3d& point);

/// The same points (x right, y down, z forward) as an upright picture: azimuth grows along the rows and
/// elevation (positive downwards) down the columns. Scanners count rows from below as well as from above, and
/// turn either way.
PointImage upright(PointImage points);

}  // namespace vdbfuse
