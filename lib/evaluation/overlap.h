// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/mesh/closest_point.h"
#include "vdbfuse/mesh/winding_number.h"

namespace vdbfuse {

/// One of the two meshes, with what answers questions about it.
struct Solid {
  const WindingNumber& winding;
  const ClosestPoint& surface;
  Box box;      ///< of its finite triangles; may be empty
  bool closed;  ///< a closed manifold, whose winding number changes at its surface only
};

struct OverlapOptions {
  int resolution;  ///< cells along the longest side of a box
  std::uint64_t seed;
  std::optional<double> deep = std::nullopt;  ///< as in EvaluateOptions
};

/// None where there is nothing to divide by, and for the volumes also when `deep` was not asked for.
struct Overlap {
  std::optional<double> iou;
  std::optional<double> false_outside_deep, false_inside_deep;  ///< as in Evaluation
};

/// Box of the vertices of finite triangles; empty when there is none.
Box finiteBox(const TriangleMesh& mesh);

/// By one random point in each cell of a grid over the truth's box, and of a second grid over both boxes for
/// what lies outside of the truth's: wild triangles far away do not make the first grid coarse. Blocks of
/// cells away from a surface are decided by their centre.
Overlap overlap(const Solid& mesh, const Solid& truth, const OverlapOptions& options);

}  // namespace vdbfuse
