// SPDX-License-Identifier: Apache-2.0
// What vdbfuse.Mesh holds.
#pragma once

#include <memory>
#include <vector>

#include "python/binding.h"
#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse::python {

/// Never changed once made: numpy's arrays lie in it.
struct Mesh {
  TriangleMesh mesh;
  py::dict report;  ///< of the reconstruction; empty: the mesh comes from elsewhere
  std::shared_ptr<const std::vector<ScalarGrid>> grids = nullptr;  ///< where they were kept
};

/// REQUIRES: the interpreter's lock is held.
inline std::shared_ptr<Mesh> makeMesh(TriangleMesh mesh) {
  return std::make_shared<Mesh>(Mesh{std::move(mesh), py::dict()});
}

}  // namespace vdbfuse::python
