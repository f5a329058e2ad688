// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// Gives each fan of triangles around the named vertices a vertex of its own, at the same place: where
/// opposite cubes around a vertex are left out, two open fans would touch in a point. REQUIRES: `vertices`
/// are sorted, without repeats; the mesh is edge-manifold.
void splitFans(TriangleMesh& mesh, const std::vector<std::uint32_t>& vertices);

}  // namespace vdbfuse
