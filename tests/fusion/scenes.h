// SPDX-License-Identifier: Apache-2.0
// Depth maps of spheres and planes, exact or with planted noise.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "vdbfuse/base/random.h"
#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse::test {

/// Distance along a ray (unit direction) to the first surface; nothing for 0.
using CastRay = std::function<double(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction)>;

inline CastRay sphereCaster(double radius, const Eigen::Vector3d& centre = Eigen::Vector3d::Zero()) {
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const double b = direction.dot(centre - origin);
    const double under_root = b * b - (centre - origin).squaredNorm() + radius * radius;
    return under_root > 0 ? b - std::sqrt(under_root) : 0.0;
  };
}

/// The plane z = height, seen from both sides.
inline CastRay planeCaster(double height) {
  return [=](const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    return std::max(0.0, (height - origin.z()) / direction.z());
  };
}

inline View castView(const Eigen::Vector3d& eye, const Eigen::Vector3d& target, const Pinhole& camera,
                     const CastRay& cast) {
  View view;
  view.name = "view";
  view.projection = camera;
  view.world_from_camera = lookAt(eye, target, {0.1, 0.2, 1});
  view.map.depth = Image<float>(camera.width, camera.height);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray = unproject(camera, x, y, 1.0);
      const double distance = cast(eye, view.world_from_camera.linear() * ray.normalized());
      if (distance > 0) view.map.depth(x, y) = static_cast<float>(distance / ray.norm());
    }
  return view;
}

/// A camera whose image just holds a ball of `radius` at `distance`.
inline Pinhole cameraFor(int size, double radius, double distance) {
  const double focal = 0.48 * size / std::tan(std::asin(radius / distance));
  return {size, size, focal, focal, 0.5 * (size - 1), 0.5 * (size - 1), {}};
}

inline Eigen::Vector3d fibonacciDirection(int index, int count) {
  const double z = 1 - (2 * index + 1.0) / count, turn = index * std::numbers::pi * (3 - std::sqrt(5.0));
  return {std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
}

inline constexpr double kSphereRadius = 0.5, kSphereDistance = 2.0;

/// A sphere around the origin from all sides.
inline std::vector<View> sphereViews(int count, int size = 64, double radius = kSphereRadius,
                                     double distance = kSphereDistance) {
  std::vector<View> views;
  for (int i = 0; i < count; ++i)
    views.push_back(castView(distance * fibonacciDirection(i, count), Eigen::Vector3d::Zero(),
                             cameraFor(size, radius, distance), sphereCaster(radius)));
  return views;
}

/// Gaussian noise of the given law on every valid depth.
inline void addNoise(std::vector<View>& views, const NoiseLaw& law, std::uint64_t seed) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    Random random(seed, i);
    for (float& d : views[i].map.depth)
      if (d != kInvalidDepth) d = static_cast<float>(d + law.at(d) * random.normal());
  }
}

inline SensorModel sphereSensor(double noise = 0.005) { return {gaussianNoise(), {noise, 0, 0}, 1.3, 2.7}; }

inline std::vector<const ViewHeader*> headersOf(const std::vector<View>& views) {
  std::vector<const ViewHeader*> headers;
  for (const View& view : views) headers.push_back(&view);
  return headers;
}

}  // namespace vdbfuse::test
