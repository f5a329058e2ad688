// SPDX-License-Identifier: Apache-2.0
// The cut decides topology, in voxels; where its surface runs, in voxels too, the measurements know better.
#pragma once

#include <cstddef>
#include <vector>

#include "surface/measure.h"

namespace vdbfuse {

/// Gives voxels whose `may_change` is not 0 the side that the sign of `field` asks for, wherever that does
/// not change the topology (isSimple()). The largest contradictions first; the same for every number of
/// threads. Returns how many changed.
std::size_t settleSides(const std::vector<float>& field, const std::vector<float>& may_change,
                        BlockField& sides);

}  // namespace vdbfuse
