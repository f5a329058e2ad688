// SPDX-License-Identifier: Apache-2.0
// Organised points: one point a pixel, as depth cameras and PCL give them, in place of depth and a
// projection.
#pragma once

#include <Eigen/Core>

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// A point a pixel; non-finite where nothing was measured.
using PointImage = Image<Eigen::Vector3f>;

/// An image of NaN.
PointImage noPoints(int width, int height);

/// The undistorted pinhole camera that sees every point, given in its frame, at the point's pixel: least
/// squares, u = fx x/z + cx and v = fy y/z + cy. Throws InvalidArgument when fewer than 16 points have z > 0,
/// when they do not fix the camera, or when they lie more than half a pixel off (root of the mean square):
/// then no pinhole took them.
Pinhole fitPinhole(const PointImage& points);

/// The turning scanner that sees every point, given in its frame, at the point's pixel: least squares of
/// azimuth by column and elevation by row, as fitPinhole().
Spherical fitSpherical(const PointImage& points);

/// The view that pixels and points in the frame of `projection` make; depth is what the projection says of
/// each point. Throws InvalidArgument when the image is not of the projection's size.
View viewFromPoints(const PointImage& points, const Projection& projection,
                    const RigidTransform& world_from_camera);

/// The inverse: points in the sensor's frame, NaN where the depth is invalid.
PointImage pointsOf(const View& view);

}  // namespace vdbfuse
