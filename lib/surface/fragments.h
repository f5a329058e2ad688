// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "surface/block_set.h"

namespace vdbfuse {

/// Gives components of at most `most` voxels the other side, where they hold a voxel of `invented` (not 0) or
/// touch one: what the completion has cut off or enclosed. Insides join across edges, outsides across faces,
/// as in extractSurface(). Components that reach out of the blocks stay. Returns how many changed.
std::size_t dropFragments(const std::vector<float>& invented, std::size_t most, BlockField& sides);

/// Gives components that fit into a cube of `width` voxels the other side, joined as above: they are narrower
/// than the grid can show, whereas a thin part is longer or hangs on something. Components that reach out of
/// the blocks stay. Returns how many changed.
std::size_t dropUnresolved(int width, BlockField& sides);

}  // namespace vdbfuse
