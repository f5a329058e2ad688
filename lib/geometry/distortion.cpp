// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/geometry/distortion.h"

#include <Eigen/LU>
#include <algorithm>

namespace vdbfuse {
namespace {

// Value and Jacobian of the distortion of a ray.
struct Linearised {
  Eigen::Vector2d value;
  Eigen::Matrix2d jacobian;
};

Linearised linearise(const Pinhole& camera, const Eigen::Vector2d& ray) {
  const auto [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = ray.x(), y = ray.y(), r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3));  // d radial / d(r²) · 2
  Linearised result;
  result.value = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
                  y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  result.jacobian << radial + slope * x * x + 2 * p1 * y + 6 * p2 * x,
      slope * x * y + 2 * p1 * x + 2 * p2 * y, slope * x * y + 2 * p1 * x + 2 * p2 * y,
      radial + slope * y * y + 6 * p1 * y + 2 * p2 * x;
  return result;
}

// d(r · radial(r²))/dr > 0: the radial part has not folded back at any radius up to this one.
bool isMonotoneUpTo(const Pinhole& camera, double r2_end) {
  const auto [k1, k2, p1, p2, k3] = camera.distortion;
  constexpr int kSamples = 16;
  for (int i = 1; i <= kSamples; ++i) {
    const double r2 = r2_end * i / kSamples;
    if (1 + r2 * (3 * k1 + r2 * (5 * k2 + r2 * 7 * k3)) <= 0) return false;
  }
  return true;
}

}  // namespace

bool isDistorted(const Pinhole& camera) {
  return std::any_of(camera.distortion.begin(), camera.distortion.end(), [](double k) { return k != 0; });
}

std::optional<Eigen::Vector2d> distort(const Pinhole& camera, const Eigen::Vector2d& ray) {
  if (!isMonotoneUpTo(camera, ray.squaredNorm())) return std::nullopt;
  return linearise(camera, ray).value;
}

Eigen::Vector2d undistort(const Pinhole& camera, const Eigen::Vector2d& distorted) {
  Eigen::Vector2d ray = distorted;
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Linearised at = linearise(camera, ray);
    const Eigen::Vector2d step = at.jacobian.partialPivLu().solve(distorted - at.value);
    if (!step.allFinite()) break;
    ray += step;
    if (step.squaredNorm() < 1e-24) break;
  }
  return ray;
}

}  // namespace vdbfuse
