// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// The surface of a field that changes: extractSurface(), but only leaves that changed, and those that touch
/// them, are worked on again. Keeps a copy of the field. Not for several threads at once; uses several
/// itself.
class LiveSurface {
 public:
  explicit LiveSurface(const GridFrame& frame);
  ~LiveSurface();
  LiveSurface(LiveSurface&&) noexcept;
  LiveSurface& operator=(LiveSurface&&) noexcept;

  /// The values of a new leaf, or new values of one. `origin`: multiples of 8.
  void set(const Index3& origin, std::span<const float, ScalarGrid::kLeafSize> values);
  /// What extractSurface() makes of the field, to the last byte.
  TriangleMesh mesh();
  /// Leaves that the last call of mesh() made triangles for.
  std::size_t meshedLeaves() const;
  std::size_t leafCount() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
