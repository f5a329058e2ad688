// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "surface/block_set.h"

namespace vdbfuse {

/// The mean of `values` around each voxel, by a Gaussian of standard deviation `sigma` voxels, which is cut
/// off at two voxels; a wider one is made of several. kUnknown values do not count, nor do voxels of weight
/// 0; without weights all others count alike. kUnknown where nothing is near. 512 values a block.
std::vector<float> smoothed(const BlockSet& blocks, const std::vector<float>& values, double sigma,
                            const std::vector<float>& weights = {});

}  // namespace vdbfuse
