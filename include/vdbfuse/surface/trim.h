// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// Cuts away the triangles with a corner of less support than `least`, and vertices that are not needed any
/// more. What is left is edge- and vertex-manifold where the mesh was, with open rims, and says so in its
/// comments. Throws InvalidArgument when the mesh has no support.
void trimUnsupported(float least, TriangleMesh& mesh);

/// Removes the components (triangles joined by vertices) whose bounding box has a diagonal below `diagonal`.
/// Returns how many.
std::size_t dropSmallComponents(double diagonal, TriangleMesh& mesh);

}  // namespace vdbfuse
