// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// The triangles of a cube of LiveSurface::kBlockSide³ voxels.
struct SurfaceBlock {
  Index3 origin;  ///< its first voxel: multiples of kBlockSide, and the block's name
  /// With normals. A vertex on the border is part of every block that meets there, at the same place and with
  /// the same normal. Empty: there is no surface in the block any more.
  TriangleMesh mesh;
};

/// The surface of a field that changes: extractSurface(), but only leaves that changed, and those that touch
/// them, are worked on again. Keeps a copy of the field. Not for several threads at once; uses several
/// itself.
class LiveSurface {
 public:
  static constexpr int kBlockSide = 32;

  explicit LiveSurface(const GridFrame& frame);
  ~LiveSurface();
  LiveSurface(LiveSurface&&) noexcept;
  LiveSurface& operator=(LiveSurface&&) noexcept;

  /// The values of a new leaf, or new values of one. `origin`: multiples of 8.
  void set(const Index3& origin, std::span<const float, ScalarGrid::kLeafSize> values);
  /// What extractSurface() makes of the field, to the last byte.
  TriangleMesh mesh();
  /// The blocks that touch what changed since the last call, in increasing order of x, y, z. All
  /// blocks that were given and not replaced are the triangles of mesh(), but for the fans along an open rim,
  /// which are not set apart.
  std::vector<SurfaceBlock> changedBlocks();
  /// Leaves that the last call of mesh() or changedBlocks() made triangles for.
  std::size_t meshedLeaves() const;
  std::size_t leafCount() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
