// SPDX-License-Identifier: Apache-2.0
#include "octree/octree_instances.h"

#include <algorithm>
#include <cmath>

#include "vdbfuse/base/random.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse::test {
namespace {

/// Distance to the ball, positive outside, in units of the domain's side; about right near the surface.
double signedDistance(const Eigen::Vector3d& p) {
  const double bump = 0.04 * std::sin(19.0 * p.x()) * std::sin(23.0 * p.y()) * std::sin(17.0 * p.z() + 1.0);
  return p.norm() - 0.3 - bump;
}

/// Agreement of depth maps around the surface.
ScalarGrid makeSupport(double voxel, std::uint64_t seed) {
  std::vector<Index3> origins;
  const int half = static_cast<int>(std::lround(0.5 / voxel));
  for (int x = -half; x < half; x += 8) {
    for (int y = -half; y < half; y += 8) {
      for (int z = -half; z < half; z += 8) {
        const Eigen::Vector3d middle = voxel * Eigen::Vector3d(x + 3.5, y + 3.5, z + 3.5);
        if (std::abs(signedDistance(middle)) < 16 * voxel) origins.push_back(leafOrigin({x, y, z}));
      }
    }
  }
  ScalarGrid grid("support", {voxel}, 0.0f, std::move(origins));
  for (std::size_t i = 0; i < grid.leafCount(); ++i) {
    ScalarGrid::Leaf leaf = grid.leaf(i);
    Random random(seed, i);
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const Eigen::Vector3d p = voxel * (leaf.origin + leafOffset(k)).cast<double>();
      const double d = signedDistance(p) / voxel;
      const double agreement = 3.0 * std::exp(-0.5 * d * d / 0.8) * random.uniform(0.5, 1.0);
      leaf.values[static_cast<std::size_t>(k)] = agreement < 0.1 ? 0.0f : static_cast<float>(agreement);
    }
  }
  return grid;
}

double evidence(OctreeFamily family, const Eigen::Vector3d& p, double voxel, Random& random) {
  const double d = signedDistance(p);
  switch (family) {
    case OctreeFamily::Carving:
      if (d > 0.5 * voxel) return random.uniform() < 0.8 ? 1.0 + 0.5 * random.normal() : 0.0;
      return d > -2.0 * voxel ? -random.uniform() : -0.02;
    case OctreeFamily::Seeds:
      return d < -0.15 ? -1.0 : 0.0;  // the border is the other seed
    case OctreeFamily::OneSided:
      if (d > 0 && !(p.x() > 0 && std::hypot(p.y(), p.z()) < 0.3)) return 1.0 + 0.5 * random.normal();
      return d > -2.0 * voxel && d < 0 && p.x() < 0 ? -random.uniform() : -0.02 * random.uniform();
  }
  return 0;
}

}  // namespace

std::string name(OctreeFamily family) {
  switch (family) {
    case OctreeFamily::Carving:
      return "Carving";
    case OctreeFamily::Seeds:
      return "Seeds";
    case OctreeFamily::OneSided:
      return "OneSided";
  }
  return "";
}

OctreeInstance octreeInstance(OctreeFamily family, int resolution, std::uint64_t seed) {
  const double voxel = 1.0 / resolution;
  const ScalarGrid support = makeSupport(voxel, seed);
  OctreeInstance instance;
  const Eigen::Vector3d corner = Eigen::Vector3d::Constant(0.5 - voxel);
  instance.octree = buildOctree(support, 0.1f, Box(-corner, corner));
  instance.tiles = tileCells(instance.octree);
  instance.support = sampleCells(instance.octree, support, 0.3f);
  Random random(seed, 1u << 30);
  for (std::size_t c = 0; c < instance.octree.cellCount(); ++c) {
    const Eigen::Vector3d middle =
        instance.octree.lowest(c).cast<double>().array() + 0.5 * (instance.octree.side(c) - 1);
    instance.sigma.push_back(
        static_cast<float>(evidence(family, instance.octree.frame.toWorld(middle), voxel, random)));
  }
  instance.options.lambda = 0.6 / voxel;
  return instance;
}

}  // namespace vdbfuse::test
