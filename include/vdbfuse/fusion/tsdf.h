// SPDX-License-Identifier: Apache-2.0
// Curless & Levoy, "A volumetric method for building complex models from range images", SIGGRAPH 1996: the
// baseline.
#pragma once

#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/judged_view.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

struct TsdfOptions {
  /// Distances are cut off at ±truncation; points further behind a measurement are not touched by it. Length.
  double truncation = 0.0;
};

struct TsdfVolume {
  ScalarGrid distance;  ///< mean of min(D − d, truncation), > 0 outside; kUnknown where nothing was measured
  ScalarGrid weight;    ///< number of measurements
};

/// Truncated weighted average over all views, each pixel with weight 1, on the voxels near any measurement
/// inside `domain`. Does not use the pixels' reliability.
TsdfVolume integrateTsdf(const JudgedViews& judged, const GridFrame& frame, const Box& domain,
                         const TsdfOptions& options, const Progress& progress = {});

/// Σ_i (D_i − d_i)/s_i at each point, not truncated, not normalised: what (11) says the evidence is for
/// logistic noise, no outliers, a flat depth prior and no self-occlusion. s_i is the scale of lookupNoise().
std::vector<double> untruncatedSum(const JudgedViews& judged, const std::vector<Eigen::Vector3d>& points);

}  // namespace vdbfuse
