// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// Longest side · perimeter / (4 √3 · area) over all triangles: 1 for an equilateral one, large for slivers,
/// infinite without area. All 0 for a mesh without triangles.
struct AspectReport {
  double median = 0;
  double quantile99 = 0;
  double largest = 0;
};
AspectReport aspects(const TriangleMesh& mesh);

}  // namespace vdbfuse
