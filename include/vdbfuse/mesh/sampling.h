// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

struct SurfaceSample {
  Eigen::Vector3d point;   ///< world coordinates
  std::uint32_t triangle;  ///< that holds it
};

/// `count` points of the surface, uniform by area: sample k is uniform in the k-th of `count` parts of equal
/// area, in the order of the triangles, so that every triangle gets its share but for two samples. The same
/// points for the same seed, mesh and count. Empty when no triangle has a finite area. REQUIRES: every index
/// of the mesh in range.
std::vector<SurfaceSample> sampleSurface(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed);

}  // namespace vdbfuse
