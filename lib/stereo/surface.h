// SPDX-License-Identifier: Apache-2.0
// The surface that a sweep goes along: what was found before, without holes and noise.
#pragma once

#include "vdbfuse/geometry/image.h"

namespace vdbfuse::stereo {

/// What is known of every pixel of a level.
struct DepthLayer {
  Image<float> inverse_depth;  ///< 0: nothing was found
  Image<float> score;          ///< Mode::score
  Image<float> second;         ///< score of the next best mode
  Image<std::uint8_t> voters;
  Image<float> spread2;  ///< Mode::spread2, as inverse depth
};
DepthLayer emptyLayer(int width, int height);

/// Pixels without a value get the mean of those around, nearest first (pull and push over a pyramid). Where
/// there is none at all: `otherwise`.
Image<float> filled(const Image<float>& inverse_depth, float otherwise);

/// Weighted mean over a square of `radius` pixels, a pixel counting by its score and by how near its value is
/// to the middle's: (1 + (Δ/scale)²)⁻². Pixels without a value stay so.
Image<float> smoothed(const DepthLayer& layer, int radius, float scale);

/// For a level of twice the size: linear between values within `step` of each other, else the nearest.
DepthLayer doubled(const DepthLayer& layer, int width, int height, float step);

}  // namespace vdbfuse::stereo
