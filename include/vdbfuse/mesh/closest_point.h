// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// The point of a surface that is nearest to a query.
struct SurfacePoint {
  double distance;         ///< from the query; infinite when the surface has no triangle
  Eigen::Vector3d point;   ///< on the surface, world coordinates
  std::uint32_t triangle;  ///< that holds it
};

/// Exact closest points on a mesh, by FLANN's exact k-d tree over the centroids of the triangles. Large
/// triangles are cut into pieces for the index only, so that no piece reaches further than R from its
/// centroid: a triangle nearer than the best one so far, at distance u, has a centroid nearer than u + R.
/// Triangles with a vertex that is not finite are ignored. Keeps a copy of the triangles' corners.
class ClosestPoint {
 public:
  /// REQUIRES: every index of the mesh in range.
  explicit ClosestPoint(const TriangleMesh& mesh);
  ~ClosestPoint();
  ClosestPoint(ClosestPoint&&) noexcept;
  ClosestPoint& operator=(ClosestPoint&&) noexcept;

  /// Safe from any number of threads. REQUIRES: a finite point.
  SurfacePoint query(const Eigen::Vector3d& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Distance of each vertex from the surface, a float each.
std::vector<float> vertexDistances(const TriangleMesh& mesh, const ClosestPoint& surface);

/// The point of the triangle a b c that is nearest to `point`; triangles without area are segments or points.
Eigen::Vector3d closestPointOnTriangle(const Eigen::Vector3d& point, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace vdbfuse
