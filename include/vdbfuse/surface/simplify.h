// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

struct SimplifyOptions {
  /// Triangles to be left, about. 0: as few as the tolerance allows.
  std::size_t triangles = 0;
  /// Largest distance from the mesh, its unit. 0: any.
  double tolerance = 0;
  /// MayChange is for looking at: the number of triangles is reached wherever it can be, and thin parts may
  /// grow together or vanish.
  enum class Topology { Keep, MayChange } topology = Topology::Keep;
};

struct SimplifyReport {
  std::size_t triangles = 0;  ///< left
  double error = 0;           ///< estimate of the distance from the mesh (quadrics), its unit
};

/// Fewer triangles where the surface is flat (edges collapse in the order of their quadric error; Garland and
/// Heckbert 1997, as meshoptimizer does it). Vertices stay where they are and keep their attributes. A mesh
/// that is closed and manifold stays so, with the same components and handles: where the library would break
/// that, more triangles are left (Topology::Keep). Throws InvalidArgument when neither a number nor a
/// tolerance is given.
SimplifyReport simplify(const SimplifyOptions& options, TriangleMesh& mesh);

}  // namespace vdbfuse
