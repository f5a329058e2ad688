// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/projection.h"

#include <algorithm>
#include <numbers>

#include "vdbfuse/geometry/distortion.h"

namespace vdbfuse {

std::optional<PixelDepth> project(const Pinhole& camera, const Eigen::Vector3d& point) {
  if (!(point.z() > 0)) return std::nullopt;
  Eigen::Vector2d ray(point.x() / point.z(), point.y() / point.z());
  if (isDistorted(camera)) {
    const std::optional<Eigen::Vector2d> distorted = distort(camera, ray);
    if (!distorted) return std::nullopt;
    ray = *distorted;
  }
  return PixelDepth{camera.fx * ray.x() + camera.cx, camera.fy * ray.y() + camera.cy, point.z()};
}

Eigen::Vector3d unproject(const Pinhole& camera, double x, double y, double depth) {
  Eigen::Vector2d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy);
  if (isDistorted(camera)) ray = undistort(camera, ray);
  return {ray.x() * depth, ray.y() * depth, depth};
}

std::optional<PixelDepth> project(const Spherical& scanner, const Eigen::Vector3d& point) {
  const double range = point.norm();
  if (!(range > 0)) return std::nullopt;
  // Azimuths are measured from the middle column, so that a full turn has its seam at the image's edge.
  const double middle = scanner.azimuth0 + 0.5 * (scanner.width - 1) * scanner.azimuth_step;
  const double turn = 2.0 * std::numbers::pi;
  const double azimuth = std::remainder(std::atan2(point.x(), point.z()) - middle, turn) + middle;
  const double elevation = std::atan2(point.y(), std::hypot(point.x(), point.z()));
  return PixelDepth{(azimuth - scanner.azimuth0) / scanner.azimuth_step,
                    (elevation - scanner.elevation0) / scanner.elevation_step, range};
}

Eigen::Vector3d unproject(const Spherical& scanner, double x, double y, double depth) {
  const double azimuth = scanner.azimuth0 + scanner.azimuth_step * x;
  const double elevation = scanner.elevation0 + scanner.elevation_step * y;
  return depth * Eigen::Vector3d(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                 std::cos(azimuth) * std::cos(elevation));
}

std::optional<PixelDepth> project(const Orthographic& sensor, const Eigen::Vector3d& point) {
  if (!(point.z() > 0)) return std::nullopt;
  return PixelDepth{(point.x() - sensor.x0) / sensor.x_step, (point.y() - sensor.y0) / sensor.y_step,
                    point.z()};
}

Eigen::Vector3d unproject(const Orthographic& sensor, double x, double y, double depth) {
  return {sensor.x0 + sensor.x_step * x, sensor.y0 + sensor.y_step * y, depth};
}

std::optional<PixelDepth> project(const PushBroom& sensor, const Eigen::Vector3d& point) {
  if (!(point.z() > 0)) return std::nullopt;
  const double column = (point.x() - sensor.x0 - sensor.x_shear * point.z()) / sensor.x_step;
  return PixelDepth{column, sensor.fy * point.y() / point.z() + sensor.cy, point.z()};
}

Eigen::Vector3d unproject(const PushBroom& sensor, double x, double y, double depth) {
  return {sensor.x0 + sensor.x_step * x + sensor.x_shear * depth, (y - sensor.cy) / sensor.fy * depth, depth};
}

std::optional<PixelDepth> project(const Projection& projection, const Eigen::Vector3d& point) {
  return std::visit([&](const auto& p) { return project(p, point); }, projection);
}

Eigen::Vector3d unproject(const Projection& projection, double x, double y, double depth) {
  return std::visit([&](const auto& p) { return unproject(p, x, y, depth); }, projection);
}

Eigen::Vector3d rayDirection(const Projection& projection, double x, double y, double depth) {
  const Eigen::Vector3d here = unproject(projection, x, y, depth);
  const Eigen::Vector3d further = unproject(projection, x, y, 2.0 * depth);
  return (further - here).normalized();
}

namespace {

struct Footprint {
  double depth;
  double operator()(const Pinhole& p) const { return depth / std::sqrt(p.fx * p.fy); }
  double operator()(const Spherical& p) const {
    return depth * std::sqrt(std::abs(p.azimuth_step * p.elevation_step));
  }
  double operator()(const Orthographic& p) const { return std::sqrt(std::abs(p.x_step * p.y_step)); }
  double operator()(const PushBroom& p) const { return std::sqrt(std::abs(p.x_step * depth / p.fy)); }
};

double scaledCentre(double centre, double factor) { return (centre + 0.5) * factor - 0.5; }

// First coordinate and step of a row of samples that is divided into more or fewer parts.
void scaleSamples(double& first, double& step, double factor) {
  first += step * (0.5 / factor - 0.5);
  step /= factor;
}

struct Scale {
  double factor;
  int pixels(int count) const { return std::max(1, static_cast<int>(std::lround(count * factor))); }
  Projection operator()(Pinhole p) const {
    p = {pixels(p.width), pixels(p.height),           p.fx * factor,
         p.fy * factor,   scaledCentre(p.cx, factor), scaledCentre(p.cy, factor),
         p.distortion};
    return p;
  }
  Projection operator()(Spherical p) const {
    p.width = pixels(p.width), p.height = pixels(p.height);
    scaleSamples(p.azimuth0, p.azimuth_step, factor);
    scaleSamples(p.elevation0, p.elevation_step, factor);
    return p;
  }
  Projection operator()(Orthographic p) const {
    p.width = pixels(p.width), p.height = pixels(p.height);
    scaleSamples(p.x0, p.x_step, factor);
    scaleSamples(p.y0, p.y_step, factor);
    return p;
  }
  Projection operator()(PushBroom p) const {
    p.width = pixels(p.width), p.height = pixels(p.height);
    scaleSamples(p.x0, p.x_step, factor);
    p.fy *= factor, p.cy = scaledCentre(p.cy, factor);
    return p;
  }
};

struct Validate {
  std::vector<std::string> problems;
  void require(bool good, const char* sentence) {
    if (!good) problems.emplace_back(sentence);
  }
  void operator()(const Pinhole& p) {
    require(p.fx > 0 && p.fy > 0 && std::isfinite(p.fx + p.fy), "focal lengths must be positive");
    require(std::isfinite(p.cx + p.cy), "the principal point must be finite");
    const bool finite =
        std::all_of(p.distortion.begin(), p.distortion.end(), [](double k) { return std::isfinite(k); });
    require(finite, "distortion coefficients must be finite");
  }
  void operator()(const Spherical& p) {
    require(p.azimuth_step != 0 && p.elevation_step != 0, "angular steps must not be zero");
    require(std::isfinite(p.azimuth0 + p.azimuth_step + p.elevation0 + p.elevation_step),
            "angles must be finite");
  }
  void operator()(const Orthographic& p) {
    require(p.x_step != 0 && p.y_step != 0, "pixel steps must not be zero");
    require(std::isfinite(p.x0 + p.x_step + p.y0 + p.y_step), "positions must be finite");
  }
  void operator()(const PushBroom& p) {
    require(p.x_step != 0 && p.fy != 0, "column step and row focal length must not be zero");
    require(std::isfinite(p.x0 + p.x_step + p.x_shear + p.fy + p.cy), "positions must be finite");
  }
};

}  // namespace

double footprint(const Projection& projection, double depth) {
  return std::visit(Footprint{depth}, projection);
}

int imageWidth(const Projection& projection) {
  return std::visit([](const auto& p) { return p.width; }, projection);
}

int imageHeight(const Projection& projection) {
  return std::visit([](const auto& p) { return p.height; }, projection);
}

Projection scaled(const Projection& projection, double factor) {
  return std::visit(Scale{factor}, projection);
}

std::vector<std::string> validate(const Projection& projection) {
  Validate check;
  check.require(imageWidth(projection) > 0 && imageHeight(projection) > 0,
                "width and height must be positive");
  std::visit(check, projection);
  return check.problems;
}

}  // namespace vdbfuse
