// SPDX-License-Identifier: Apache-2.0
// The surface that a sweep goes along: what was found before, without holes and noise.
#pragma once

#include "vdbfuse/geometry/image.h"

namespace vdbfuse::stereo {

/// What is known of every pixel of a level.
struct DepthLayer {
  Image<float> inverse_depth;  ///< 0: nothing was found
  Image<float> score;          ///< Mode::score
  Image<float> support;        ///< Mode::support
  Image<float> second;         ///< score of the next best mode
  Image<std::uint8_t> voters;
  Image<float> spread2;  ///< Mode::spread2, as inverse depth
};
DepthLayer emptyLayer(int width, int height);

/// Pixels without a value get the mean of those around, nearest first (pull and push over a pyramid). Where
/// there is none at all: `otherwise`.
Image<float> filled(const Image<float>& inverse_depth, float otherwise);

/// For a level of twice the size: linear between values within `step` of each other, else the nearest.
DepthLayer doubled(const DepthLayer& layer, int width, int height, float step);

}  // namespace vdbfuse::stereo
