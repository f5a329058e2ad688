// SPDX-License-Identifier: Apache-2.0
// How much a pixel's depth counts in a mean of measurements.
#pragma once

#include <optional>

#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Which properties of a measurement its weight is the product of.
struct WeightOptions {
  /// The probability that a pixel is right: 1 − ε of a judged view, and nothing below ¼, since many doubtful
  /// pixels add up to floating pieces; of a view, its confidence within [0, 1], where a pixel without one
  /// counts fully.
  bool confidence = true;
  /// (h/2)²/((h/2)² + s²) with s the noise of the depth: noise below half a voxel h costs nothing, and beyond
  /// it the weight falls like 1/s², that of the mean with the least variance.
  bool noise = true;
  /// Cosine between the optic ray and the surface normal: what a pixel's width does to depth grows with its
  /// tangent.
  bool incidence = true;
  /// Rises from the edges of the depth map inwards over four pixels: where sensors mix depths, and where the
  /// band behind a surface would come out at its other side. A pixel that agrees with none of the
  /// measured ones beside it counts nothing.
  bool silhouette = true;
};

/// The weight of each pixel in [0, 1], 0 where nothing was measured. `noise`: of the depth, if it is known.
Image<float> measurementWeights(const View& view, const std::optional<NoiseLaw>& noise, double voxel,
                                const WeightOptions& options);
Image<float> measurementWeights(const JudgedView& view, const NoiseLaw& noise, double voxel,
                                const WeightOptions& options);

}  // namespace vdbfuse
