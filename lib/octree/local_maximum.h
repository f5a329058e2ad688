// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// The largest value within `radius` voxels along each axis (a cube), at every voxel of the same leaves; what
/// has no leaf does not count. REQUIRES: radius in 0 … 8.
ScalarGrid localMaximum(const ScalarGrid& grid, int radius);

}  // namespace vdbfuse
