// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare: slices through what each method decided by.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/methods.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse::tool {

/// The plane of --slice; of 'auto' the one through the middle of `box` at right angles to its shortest side,
/// at a multiple of `voxel`. Throws InvalidArgument.
SlicePlane choosePlane(const std::string& text, const Box& box, double voxel);

struct SlicePlace {
  SlicePlane plane;
  Box box;
};

/// Draws slices of the grids there are into folder/slices and names them in the record.
void writeSlices(const std::filesystem::path& folder, const SlicePlace& place,
                 const std::vector<ScalarGrid>& grids, MethodRecord& record);

}  // namespace vdbfuse::tool
