// SPDX-License-Identifier: Apache-2.0
// Binary glTF in memory, as writeMesh() puts it into .glb files, with values of the caller's own.
#pragma once

#include <string>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse {

/// Becomes an attribute of the vertices. glTF wants names of one's own to begin with '_'.
struct VertexValues {
  std::string name;
  std::vector<float> values;  ///< one a vertex
};

/// The bytes of a .glb file: see writeMesh(). Throws InvalidArgument when some values are not one a vertex.
std::string glbBytes(const TriangleMesh& mesh, const std::vector<VertexValues>& more = {});

}  // namespace vdbfuse
