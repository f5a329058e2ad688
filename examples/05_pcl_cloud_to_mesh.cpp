// SPDX-License-Identifier: Apache-2.0
// Clouds of the Point Cloud Library in, a pcl::PolygonMesh out.
//   example_05_pcl_cloud_to_mesh
// The clouds are organised, as depth cameras give them: a row and a column for each point, in the sensor's
// frame, with the sensor's pose. Here six cameras look at a sphere of radius 1. Link vdbfuse::pcl.
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <vector>

#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/pcl/bridge.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr int kSide = 120;
constexpr float kFocalLength = 130, kDistance = 3;

/// What a camera at `direction` · kDistance sees of the sphere.
Cloud scanSphere(const Eigen::Vector3d& direction) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  Cloud cloud(kSide, kSide, pcl::PointXYZ(kNan, kNan, kNan));
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float center = 0.5F * (kSide - 1);
      const Eigen::Vector3f ray((static_cast<float>(x) - center) / kFocalLength,
                                (static_cast<float>(y) - center) / kFocalLength, 1);
      const float a = ray.squaredNorm(), c = kDistance * kDistance - 1;
      const float root = kDistance * kDistance - a * c;
      if (root >= 0) cloud.at(x, y).getVector3fMap() = ray * ((kDistance - std::sqrt(root)) / a);
    }
  }
  cloud.is_dense = false;
  const vdbfuse::RigidTransform pose =
      vdbfuse::lookAt(kDistance * direction, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.1, 0.2, 1));
  cloud.sensor_origin_ << pose.translation().cast<float>(), 0;
  cloud.sensor_orientation_ = Eigen::Quaterniond(pose.linear()).cast<float>();
  return cloud;
}

}  // namespace

int main() try {
  std::vector<vdbfuse::View> views;
  for (int axis = 0; axis < 3; ++axis) {
    views.push_back(vdbfuse::toView(scanSphere(Eigen::Vector3d::Unit(axis))));
    views.push_back(vdbfuse::toView(scanSphere(-Eigen::Vector3d::Unit(axis))));
  }
  vdbfuse::ReconstructOptions options;
  options.resolution = 48;
  const vdbfuse::Reconstruction result =
      reconstruct(vdbfuse::ViewSequence::fromViews(std::move(views)), options);

  const pcl::PolygonMesh mesh = vdbfuse::toPolygonMesh(result.mesh);
  const double volume = vdbfuse::signedVolume(result.mesh);
  std::printf("%zu polygons, %u vertices, volume %.2f (a sphere has 4.19)\n", mesh.polygons.size(),
              mesh.cloud.width * mesh.cloud.height, volume);
  return std::abs(volume - 4.19) < 0.2 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
