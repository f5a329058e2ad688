// SPDX-License-Identifier: Apache-2.0
// Sides of finest voxels around the surface: +1 outside, −1 inside.
#pragma once

#include <functional>
#include <vector>

#include "surface/block_set.h"
#include "vdbfuse/surface/field.h"

namespace vdbfuse {

/// The labels, on all blocks within a few voxels of the boundary between them.
BlockField labelledSides(const LabelledCells& cells, CellLabel beyond);

/// Sides on the blocks around the boundary, as far as it can be followed from the blocks at `origins`. `read`
/// gives the sides of the block at an origin.
BlockField grownSides(const GridFrame& frame, std::vector<Index3> origins,
                      const std::function<void(const Index3& origin, float* sides)>& read);

/// 1 for voxels with another side within two voxels along every axis.
std::vector<float> nearBoundary(const BlockField& sides);

/// Clears the marks of voxels that are not supported (C) and share no face with one that is.
void keepSupported(const BlockSet& blocks, const ScalarGrid& support, float supported,
                   std::vector<float>& marks);

/// Gives every value of `field` the sign of its side, at least `least` large: zero would count as outside.
void putBack(const BlockField& sides, float least, std::vector<float>& field);

}  // namespace vdbfuse
