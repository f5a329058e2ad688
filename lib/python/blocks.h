// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "python/mesh.h"
#include "vdbfuse/surface/live_surface.h"

namespace vdbfuse::python {

/// A tuple of three: names a block.
inline py::tuple tupleOf(const Index3& origin) { return py::make_tuple(origin.x(), origin.y(), origin.z()); }

/// Of (origin, Mesh).
inline py::list listOf(std::vector<SurfaceBlock> blocks) {
  py::list list;
  for (SurfaceBlock& block : blocks)
    list.append(py::make_tuple(tupleOf(block.origin), makeMesh(std::move(block.mesh))));
  return list;
}

}  // namespace vdbfuse::python
