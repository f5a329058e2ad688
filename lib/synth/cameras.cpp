// SPDX-License-Identifier: Apache-2.0
#include "cameras.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "vdbfuse/geometry/look_at.h"

namespace vdbfuse::synth {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double radians(double degrees) { return degrees * pi / 180; }

// A unit direction `height` along the axis and turned by `angle` around it, 0 towards `reference`.
Vector3d around(const Vector3d& axis, const Vector3d& reference, double height, double angle) {
  const Vector3d side = axis.cross(reference);
  return height * axis +
         std::sqrt(1 - height * height) * (std::cos(angle) * reference + std::sin(angle) * side);
}

// Point `i` of `count` spread evenly over the zone of the unit sphere between two heights along the axis.
Vector3d fibonacci(const Vector3d& axis, const Vector3d& reference, double low, double high, int i,
                   int count) {
  const double golden_angle = pi * (3 - std::sqrt(5.0));
  return around(axis, reference, high - (high - low) * (i + 0.5) / count, golden_angle * i);
}

RigidTransform inRoomPose(const Scene& scene, int i, int count) {
  constexpr double kRadius = 1.15, kHeights[] = {0.0, 0.55, -0.45};
  const Vector3d outward = around(scene.up, scene.front, 0, 2 * pi * i / count);
  const Vector3d eye = kRadius * outward + kHeights[i % 3] * scene.up;
  if (i % 2 == 0) return lookAt(eye, Vector3d::Zero(), scene.up);
  // Along the room rather than into the nearest wall, each a bit further up or down than the one before.
  const double tilt = radians(25.0 * (i / 2 % 5 - 2));
  const Vector3d along = scene.up.cross(outward);
  const Vector3d direction = std::cos(tilt) * (0.8 * outward + 0.6 * along) + std::sin(tilt) * scene.up;
  return lookAt(eye, eye + direction, scene.up);
}

RigidTransform pose(const Scene& scene, Arc arc, int i, int count) {
  const auto lookFrom = [&](const Vector3d& direction) {
    return lookAt(kCameraDistance * direction, Vector3d::Zero(), scene.up);
  };
  switch (arc) {
    case Arc::Full:
      return lookFrom(fibonacci(scene.up, scene.front, -1, 1, i, count));
    case Arc::Upper:
      return lookFrom(fibonacci(scene.up, scene.front, 0, 1, i, count));
    case Arc::Front:
      return lookFrom(fibonacci(scene.front, scene.up, std::cos(radians(kFrontHalfAngleDeg)), 1, i, count));
    case Arc::Ring:
      return lookFrom(
          around(scene.up, scene.front, std::sin(radians(kRingElevationDeg)), 2 * pi * i / count));
    case Arc::Room:
      return inRoomPose(scene, i, count);
  }
  return RigidTransform::Identity();
}

std::string viewName(int i) {
  char name[16];
  std::snprintf(name, sizeof name, "%08d", i);
  return name;
}

}  // namespace

std::vector<ViewHeader> placeCameras(const Scene& scene, const SynthOptions& options) {
  Pinhole camera{.width = options.width, .height = options.height};
  camera.fx = camera.fy = focalLength(options);
  camera.cx = 0.5 * (options.width - 1), camera.cy = 0.5 * (options.height - 1);
  std::vector<ViewHeader> headers;
  for (int i = 0; i < options.views; ++i)
    headers.push_back({viewName(i), camera, pose(scene, options.arc, i, options.views)});
  return headers;
}

}  // namespace vdbfuse::synth
