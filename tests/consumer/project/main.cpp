// SPDX-License-Identifier: Apache-2.0
// A program of somebody else's: 26 depth maps of a sphere in memory, one call, a closed mesh.
#include <cmath>
#include <cstdio>
#include <vector>

#include "vdbfuse/geometry/look_at.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace {

// What a camera sees of the unit sphere around the origin.
vdbfuse::View viewOfSphere(const Eigen::Vector3d& eye) {
  vdbfuse::View view;
  view.projection = vdbfuse::Pinhole{96, 96, 110, 110, 47.5, 47.5, {}};
  view.world_from_camera = vdbfuse::lookAt(eye, Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, 1));
  view.map.depth = vdbfuse::Image<float>(96, 96, vdbfuse::kInvalidDepth);
  const Eigen::Vector3d center = view.world_from_camera.inverse() * Eigen::Vector3d::Zero();
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const Eigen::Vector3d ray = vdbfuse::unproject(view.projection, x, y, 1.0);
      const double a = ray.squaredNorm(), b = ray.dot(center), c = center.squaredNorm() - 1;
      if (b * b >= a * c) view.map.depth(x, y) = static_cast<float>((b - std::sqrt(b * b - a * c)) / a);
    }
  }
  return view;
}

}  // namespace

int main() {
  std::vector<vdbfuse::View> views;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const Eigen::Vector3d direction(x, y, z);
        if (!direction.isZero()) views.push_back(viewOfSphere(3 * direction.normalized()));
      }
    }
  }
  vdbfuse::ReconstructOptions options;
  options.resolution = 32;
  const vdbfuse::Reconstruction result = reconstruct(vdbfuse::ViewSequence::fromViews(views), options);
  const auto open_edges = vdbfuse::topology(result.mesh).open_edges;
  const double volume = vdbfuse::signedVolume(result.mesh);
  std::printf("%zu triangles, %zu open edges, volume %.3f\n", result.mesh.triangles.size(),
              static_cast<std::size_t>(open_edges), volume);
  return open_edges == 0 && volume > 3.8 && volume < 4.6 ? 0 : 1;  // 4π/3 = 4.19
}
