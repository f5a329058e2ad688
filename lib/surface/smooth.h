// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "surface/block_set.h"

namespace vdbfuse {

/// The mean of `values` around each voxel, weighted by `weights` and by a Gaussian of standard deviation
/// `sigma` voxels, which is cut off at two voxels; a wider one is made of several. kUnknown where no weight
/// reaches. Voxels of weight 0 (and
/// whatever they hold) do not count. Both: 512 a block.
std::vector<float> smoothed(const BlockSet& blocks, const std::vector<float>& values,
                            const std::vector<float>& weights, double sigma);

}  // namespace vdbfuse
