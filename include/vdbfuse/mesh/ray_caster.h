// SPDX-License-Identifier: Apache-2.0
// Where rays first meet a triangle mesh (Embree, its robust mode).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

struct RayHit {
  double distance = 0;  ///< in lengths of the ray's direction: point = origin + distance · direction
  std::uint32_t triangle = 0;
  /// The point in the triangle's corners: (1 − u − v)·corner0 + u·corner1 + v·corner2.
  double u = 0, v = 0;
};

/// Single precision inside: positions are good to about 1e-6 of the scene's extent. Copies what it needs of
/// the mesh. Gives the same hits for every number of threads.
class RayCaster {
 public:
  /// Throws InvalidArgument when a triangle names a vertex that is not there.
  explicit RayCaster(const TriangleMesh& mesh);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// The first hit in front of `origin`, from either side of a triangle. Safe from any thread.
  /// `direction` need not have unit length.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
