// SPDX-License-Identifier: Apache-2.0
// What to do where a surface ends because space beside it is unknown. Seen at a grazing angle a surface is
// known and the space before it is not, in one voxel and not in the next: the rim frays over several voxels,
// into hundreds of pieces.
#pragma once

#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// The field with a value in each unknown voxel that has the surface beside it (it is the corner of a cube
/// whose known corners have both signs): the mean of what its known neighbours' differences lead to, and of
/// their side where these disagree. Holes of one voxel close, and the surface ends up to one voxel later.
ScalarGrid closeGaps(const ScalarGrid& field);

/// Removes what has no vertex further than `rings` edges from the rim within that many edges: frays, single
/// triangles, pieces narrower than twice that. A straight rim recedes by one ring of triangles, less than
/// closeGaps() adds. Vertices that are not needed any more go, too. A closed mesh stays as it is. What is
/// left is edge- and vertex-manifold where the mesh was. Returns the number of triangles removed.
std::size_t trimRim(int rings, TriangleMesh& mesh);

}  // namespace vdbfuse
