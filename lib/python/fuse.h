// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "python/fuse_options.h"
#include "python/mesh.h"

namespace vdbfuse::python {

/// The mesh with what was found out. REQUIRES: the interpreter's lock is held.
std::shared_ptr<Mesh> meshOf(Reconstruction result);

}  // namespace vdbfuse::python
