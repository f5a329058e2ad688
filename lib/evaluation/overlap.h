// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/mesh/winding_number.h"

namespace vdbfuse {

struct OverlapGrid {
  Box truth_box;
  Box mesh_box;    ///< may be empty
  int resolution;  ///< cells along the longest side of a box
  std::uint64_t seed;
};

/// Box of the vertices of finite triangles; empty when there is none.
Box finiteBox(const TriangleMesh& mesh);

/// By one random point in each cell of a grid over the truth's box, and of a second grid over both boxes for
/// what lies outside of the truth's: wild triangles far away do not make the first grid coarse.
std::optional<double> intersectionOverUnion(const WindingNumber& mesh, const WindingNumber& truth,
                                            const OverlapGrid& grid);

}  // namespace vdbfuse
