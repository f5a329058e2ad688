// SPDX-License-Identifier: Apache-2.0
#include "stereo/paper_ray.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vdbfuse/geometry/intrinsics.h"

namespace vdbfuse::stereo::paper {
namespace {

// Pixels per unit of inverse depth; 0 where the partner does not see the point.
double speed(const RayImage& ray, const Pinhole& partner, double x, double y, double w) {
  const Eigen::Vector3d point = ray.at(x, y, w);
  if (!(point.z() > 0)) return 0;
  const Eigen::Vector2d pixel = point.head<2>() / point.z();
  if (pixel.x() < 0 || pixel.y() < 0 || pixel.x() > partner.width - 1 || pixel.y() > partner.height - 1)
    return 0;
  return ((ray.b.head<2>() - pixel * ray.b.z()) / point.z()).norm();
}

double greatestSpeed(const PhotographHeader& reference, const PhotographHeader& partner,
                     const DepthInterval& depths) {
  const RayImage ray = rayImage(reference, partner);
  double greatest = 0;
  constexpr int kSamples = 4;
  for (int i = 0; i <= kSamples; ++i)
    for (int j = 0; j <= kSamples; ++j)
      for (int k = 0; k <= kSamples; ++k) {
        const double x = (reference.camera.width - 1) * i / double{kSamples};
        const double y = (reference.camera.height - 1) * j / double{kSamples};
        const double w = std::lerp(1 / depths.far, 1 / depths.near, k / double{kSamples});
        greatest = std::max(greatest, speed(ray, partner.camera, x, y, w));
      }
  return greatest;
}

}  // namespace

RayImage rayImage(const PhotographHeader& reference, const PhotographHeader& partner) {
  const RigidTransform partner_from_reference =
      partner.world_from_camera.inverse() * reference.world_from_camera;
  const Eigen::Matrix3d k = intrinsicMatrix(partner.camera);
  return {k * partner_from_reference.linear() * intrinsicMatrix(reference.camera).inverse(),
          k * partner_from_reference.translation()};
}

RaySteps raySteps(const PhotographHeader& reference, const std::vector<PhotographHeader>& partners,
                  const DepthInterval& depths, double step_px) {
  double greatest = 0;
  for (const PhotographHeader& partner : partners)
    greatest = std::max(greatest, greatestSpeed(reference, partner, depths));
  const double length = 1 / depths.near - 1 / depths.far;
  const int intervals = std::max(2, static_cast<int>(std::ceil(length * greatest / step_px)));
  return {1 / depths.far, length / intervals, intervals + 1};
}

}  // namespace vdbfuse::stereo::paper
