// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "fusion/depth_tiles.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/view.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

struct BandOptions {
  double truncation = 0.0;    ///< half the width of the band along the optic ray, length
  std::optional<Box> domain;  ///< leaves that do not meet it are left out
};

/// Origins of all leaves with voxels in the band around a depth map, and some beside them; sorted. From tiles
/// of pixels and the range of their depths; a tile is divided where its depths lie far apart. What spans more
/// than kMostLeavesOfAPixel leaves, and what lies further than 2²⁰ leaves from the grid's origin, is left
/// out: voxels far too small for the measurement. The same for any number of threads.
inline constexpr int kMostLeavesOfAPixel = 4096;
std::vector<Index3> bandLeaves(const ViewHeader& view, const Image<float>& depth, const DepthTiles& tiles,
                               const GridFrame& frame, const BandOptions& options);

}  // namespace vdbfuse
