// SPDX-License-Identifier: Apache-2.0
// What the overlap of the depth maps tells of the sensor: how large its noise is and how it grows with depth.
#pragma once

#include <optional>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/fusion/view_graph.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/sensor/noise_model.h"
#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// Depths of a data set, from a sample of the pixels of every view.
struct DepthStatistics {
  double near = 0;    ///< 0.97 × the 0.2 % quantile
  double median = 0;  ///< of what lies in the domain
  double far = 0;     ///< 1.03 × the 99.8 % quantile
};

/// Where `domain` is given and holds any point, the median is of the points inside it: a wall behind the
/// object says nothing of how far away the object is. Throws InvalidArgument when no view has a valid pixel.
DepthStatistics depthStatistics(const std::vector<View>& views,
                                const std::optional<Box>& domain = std::nullopt);

/// Noise of neighbouring pixels against each other, from second differences: a first guess that knows nothing
/// of poses. Proportional to the pixel footprint.
NoiseLaw guessNoise(const std::vector<View>& views, double typical_depth);

struct NoiseCalibration {
  NoiseLaw noise;
  int exponent = 0;            ///< of depth: 0 constant, 1 linear, 2 quadratic
  double scale_at_median = 0;  ///< s at the median depth
  std::size_t pairs = 0;       ///< pairs of pixels that were compared; below a few hundred the guess is kept
};

/// Residuals along the surface normal between views that see the same place, from near and far pairs, in bins
/// of the angle between the two rays; half-normal plus uniform by EM; the largest bin that holds enough pairs
/// counts, because poses drift. The exponent of depth is the likeliest of 0, 1, 2.
NoiseCalibration calibrateNoise(const std::vector<View>& views, const ViewGraph& graph, const NoiseLaw& guess,
                                double typical_depth, const Progress& progress = {});

}  // namespace vdbfuse
