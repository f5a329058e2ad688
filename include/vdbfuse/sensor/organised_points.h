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

/// The same points in another frame.
PointImage moved(PointImage points, const RigidTransform& b_from_a);

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

/// A sheet of laser light that was moved sideways, and where it stands.
struct FittedPushBroom {
  PushBroom sensor;
  /// Origin of the sensor's frame in that of the points; its x is 0, and the axes of both are parallel.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double error_px = 0;  ///< root of the mean square of what remains between points and pixels
};

/// The push-broom sensor that sees every point at the point's pixel. Points are given in a frame whose axes
/// are the sensor's (x right, y down, z forward), its origin anywhere: least squares of x by column and z,
/// and of row = cy + fy (y - origin.y)/(z - origin.z) with an unknown origin. fy and x_step may be negative.
/// Throws InvalidArgument as fitPinhole(), and when the rows do not converge behind the points.
FittedPushBroom fitPushBroom(const PointImage& points);

/// The view that pixels and points in the frame of `projection` make; depth is what the projection says of
/// each point. Throws InvalidArgument when the image is not of the projection's size.
View viewFromPoints(const PointImage& points, const Projection& projection,
                    const RigidTransform& world_from_camera);

/// The inverse: points in the sensor's frame, NaN where the depth is invalid.
PointImage pointsOf(const View& view);

}  // namespace vdbfuse
