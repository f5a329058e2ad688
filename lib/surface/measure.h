// SPDX-License-Identifier: Apache-2.0
// How far the surface is, by the depth maps that see this side of it.
#pragma once

#include <vector>

#include "surface/block_set.h"
#include "vdbfuse/base/progress.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// 512 values a block.
struct MeasuredField {
  std::vector<float> distance;  ///< > 0 outside, length; kUnknown where no view says anything
  std::vector<float> weight;    ///< 1/variance of the distance, 1/length²; 0 where there is none
};

/// Signed distances at the voxels whose `wanted` is not 0: the mean of (D − d)·cos over the views whose
/// measurement does not contradict the voxel's side by more than the noise, weighted by reliability,
/// incidence and precision. `sides`: +1 outside, −1 inside.
MeasuredField measureDistances(const JudgedViews& judged, const BlockField& sides,
                               const std::vector<float>& wanted, const Progress& progress = {});

/// How far `field` is from the measurements, > 0 where it should grow, at the voxels whose `wanted` is not 0;
/// its values there become distances, by its own slope. Looks along the normal at the point of the surface
/// nearest to the voxel, so that neither slant nor curvature matters; depths are interpolated between pixels
/// of one surface.
MeasuredField measureResiduals(const JudgedViews& judged, const std::vector<float>& wanted, BlockField& field,
                               const Progress& progress = {});

}  // namespace vdbfuse
