// SPDX-License-Identifier: Apache-2.0
// How a sensor's pixels are spread over the space in front of it. One closed type: a variant, not a class
// tree. Camera frame: x right, y down, z forward; pixel centres at integer (x, y). Each projection has its
// own measure of depth: z for a pinhole, range for a spherical scanner, distance along the axis for the other
// two. Depth is > 0.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace vdbfuse {

/// A perspective camera with Brown–Conrady distortion. Depth is z.
struct Pinhole {
  int width = 0, height = 0;
  double fx = 0, fy = 0;  ///< focal lengths, pixels
  double cx = 0, cy = 0;  ///< principal point, pixels
  /// k1, k2, p1, p2, k3 in the order of OpenCV; all zero: no distortion.
  std::array<double, 5> distortion{};
  bool operator==(const Pinhole&) const = default;
};

/// A turning scanner: column = (azimuth − azimuth0)/azimuth_step with azimuth = atan2(x, z), row = (elevation
/// − elevation0)/elevation_step with elevation = atan2(y, √(x²+z²)) (positive downwards). Radians. Depth is
/// range.
struct Spherical {
  int width = 0, height = 0;
  double azimuth0 = 0, azimuth_step = 0;
  double elevation0 = 0, elevation_step = 0;
  bool operator==(const Spherical&) const = default;
};

/// Parallel rays along z: x = x0 + x_step·column, y = y0 + y_step·row. Depth is z.
struct Orthographic {
  int width = 0, height = 0;
  double x0 = 0, x_step = 0;
  double y0 = 0, y_step = 0;
  bool operator==(const Orthographic&) const = default;
};

/// A sheet of laser light moved sideways: columns are parallel planes x = x0 + x_step·column + x_shear·z,
/// rows converge in perspective, y = (row − cy)/fy · z. Depth is z.
struct PushBroom {
  int width = 0, height = 0;
  double x0 = 0, x_step = 0, x_shear = 0;
  double fy = 0, cy = 0;
  bool operator==(const PushBroom&) const = default;
};

using Projection = std::variant<Pinhole, Spherical, Orthographic, PushBroom>;

/// A position in an image, with the depth of the point that falls there in the sensor's own measure.
struct PixelDepth {
  double x = 0, y = 0;
  double depth = 0;
};

/// Where a point of the camera frame is seen; nothing when it lies at depth ≤ 0. May lie outside the image.
std::optional<PixelDepth> project(const Pinhole& camera, const Eigen::Vector3d& point);
std::optional<PixelDepth> project(const Spherical& scanner, const Eigen::Vector3d& point);
std::optional<PixelDepth> project(const Orthographic& sensor, const Eigen::Vector3d& point);
std::optional<PixelDepth> project(const PushBroom& sensor, const Eigen::Vector3d& point);
std::optional<PixelDepth> project(const Projection& projection, const Eigen::Vector3d& point);

/// The point of the camera frame that pixel (x, y) sees at `depth`: the inverse of project().
Eigen::Vector3d unproject(const Pinhole& camera, double x, double y, double depth);
Eigen::Vector3d unproject(const Spherical& scanner, double x, double y, double depth);
Eigen::Vector3d unproject(const Orthographic& sensor, double x, double y, double depth);
Eigen::Vector3d unproject(const PushBroom& sensor, double x, double y, double depth);
Eigen::Vector3d unproject(const Projection& projection, double x, double y, double depth);

/// Unit direction in which a point's depth grows fastest for the pixel that sees it: the optic ray, in the
/// camera frame, at the given depth.
Eigen::Vector3d rayDirection(const Projection& projection, double x, double y, double depth);

/// Distance between neighbouring pixels' points on a surface that faces the sensor at `depth`.
double footprint(const Projection& projection, double depth);

int imageWidth(const Projection& projection);
int imageHeight(const Projection& projection);

/// The same sensor with another number of pixels: width and height multiplied by `factor` and rounded,
/// c' = (c + ½)·factor − ½.
Projection scaled(const Projection& projection, double factor);

/// Everything that is wrong with a projection, one sentence each; empty when it can be used.
std::vector<std::string> validate(const Projection& projection);

/// Nearest integer pixel; half-way cases go up. Points within half a pixel of the image's outer centres are
/// inside.
inline int nearestPixel(double coordinate) { return static_cast<int>(std::floor(coordinate + 0.5)); }

}  // namespace vdbfuse
