// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/sensor/organised_points.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kFewestPoints = 16;
constexpr double kLargestErrorPx = 0.5;

bool isSeen(const Eigen::Vector3f& point) { return point.allFinite() && point.z() > 0; }

// Least squares of pixel = focal·slope + center over many points.
class LineFit {
 public:
  void add(double slope, double pixel) {
    count_ += 1;
    const double ds = slope - mean_slope_, dp = pixel - mean_pixel_;
    mean_slope_ += ds / count_;
    mean_pixel_ += dp / count_;
    slopes_ += ds * (slope - mean_slope_);
    both_ += ds * (pixel - mean_pixel_);
    pixels_ += dp * (pixel - mean_pixel_);
  }
  double focal() const { return both_ / slopes_; }
  double center() const { return mean_pixel_ - focal() * mean_slope_; }
  double meanSquareError() const { return std::max(0.0, pixels_ - both_ * focal()) / count_; }

 private:
  double count_ = 0, mean_slope_ = 0, mean_pixel_ = 0, slopes_ = 0, both_ = 0, pixels_ = 0;
};

}  // namespace

PointImage moved(PointImage points, const RigidTransform& b_from_a) {
  for (Eigen::Vector3f& p : points) p = (b_from_a * p.cast<double>()).cast<float>();
  return points;
}

PointImage noPoints(int width, int height) {
  return {width, height, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())};
}

Pinhole fitPinhole(const PointImage& points) {
  LineFit across, down;
  std::size_t seen = 0;
  for (int y = 0; y < points.height(); ++y) {
    for (int x = 0; x < points.width(); ++x) {
      const Eigen::Vector3d p = points(x, y).cast<double>();
      if (!isSeen(points(x, y))) continue;
      across.add(p.x() / p.z(), x);
      down.add(p.y() / p.z(), y);
      ++seen;
    }
  }
  if (seen < kFewestPoints)
    throw InvalidArgument(
        "points", "expected at least 16 points in front of the camera, found " + std::to_string(seen));
  const Pinhole camera{
      points.width(), points.height(), across.focal(), down.focal(), across.center(), down.center(), {}};
  if (!validate(Projection(camera)).empty())
    throw InvalidArgument("points",
                          "expected points of a camera (x right, y down, z forward), found none that fit");
  const double error_px = std::sqrt(across.meanSquareError() + down.meanSquareError());
  if (!(error_px <= kLargestErrorPx))
    throw InvalidArgument("points", "expected points of a pinhole camera, found them " +
                                        std::to_string(error_px) + " pixels off the best one");
  return camera;
}

Spherical fitSpherical(const PointImage& points) {
  // Azimuths are taken from column to column, so that they run on over a full turn.
  LineFit azimuths, elevations;
  double last_azimuth = 0;
  std::size_t seen = 0;
  for (int x = 0; x < points.width(); ++x) {
    for (int y = 0; y < points.height(); ++y) {
      const Eigen::Vector3d p = points(x, y).cast<double>();
      const double level = std::hypot(p.x(), p.z());
      if (!p.allFinite() || !(level > 0)) continue;
      const double azimuth = std::atan2(p.x(), p.z());
      last_azimuth =
          seen == 0 ? azimuth : last_azimuth + std::remainder(azimuth - last_azimuth, 2 * std::numbers::pi);
      azimuths.add(x, last_azimuth);
      elevations.add(y, std::atan2(p.y(), level));
      ++seen;
    }
  }
  if (seen < kFewestPoints)
    throw InvalidArgument("points", "expected at least 16 points, found " + std::to_string(seen));
  const Spherical scanner{points.width(),   points.height(),     azimuths.center(),
                          azimuths.focal(), elevations.center(), elevations.focal()};
  const double pixel = std::min(std::abs(scanner.azimuth_step), std::abs(scanner.elevation_step));
  const double error_px =
      std::sqrt(azimuths.meanSquareError() + elevations.meanSquareError()) / std::max(pixel, 1e-12);
  if (!validate(Projection(scanner)).empty() || !(error_px <= kLargestErrorPx))
    throw InvalidArgument("points", "expected points of a turning scanner, found them " +
                                        std::to_string(error_px) + " pixels off the best one");
  return scanner;
}

View viewFromPoints(const PointImage& points, const Projection& projection,
                    const RigidTransform& world_from_camera) {
  if (points.width() != imageWidth(projection) || points.height() != imageHeight(projection))
    throw InvalidArgument("points", "expected an image of the projection's size");
  View view;
  view.projection = projection;
  view.world_from_camera = world_from_camera;
  view.map.depth = Image<float>(points.width(), points.height(), kInvalidDepth);
  for (int y = 0; y < points.height(); ++y) {
    for (int x = 0; x < points.width(); ++x) {
      if (!points(x, y).allFinite()) continue;
      const auto seen = project(projection, points(x, y).cast<double>());
      if (seen) view.map.depth(x, y) = static_cast<float>(seen->depth);
    }
  }
  normaliseInvalid(view.map.depth);
  return view;
}

PointImage pointsOf(const View& view) {
  const Image<float>& depth = view.map.depth;
  PointImage points = noPoints(depth.width(), depth.height());
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (depth(x, y) != kInvalidDepth)
        points(x, y) = unproject(view.projection, x, y, depth(x, y)).cast<float>();
    }
  }
  return points;
}

}  // namespace vdbfuse
