// SPDX-License-Identifier: Apache-2.0
// The surface that a sweep goes along: what was found before, without holes and noise.
#pragma once

#include "stereo/plane_fit.h"
#include "stereo/vote_kernels.h"
#include "vdbfuse/geometry/image.h"

namespace vdbfuse::stereo {

/// What is known of every pixel of a level.
struct DepthLayer {
  Image<float> inverse_depth;  ///< 0: nothing was found
  Image<float> score;          ///< ModeRows::score
  Image<float> support;        ///< ModeRows::support
  Image<float> second;         ///< ModeRows::second
  Image<std::uint8_t> voters;
  Image<float> spread2;  ///< ModeRows::spread2, as inverse depth
};
DepthLayer emptyLayer(int width, int height);

/// Sets all of the pixel (x, y) to what that pixel of a tile voted for. `step`: inverse depth of a step.
void store(const ModeRows& modes, std::size_t pixel, float inverse_depth, float step, int x, int y,
           DepthLayer& layer);

/// Pixels without a value get the mean of those around, nearest first (pull and push over a pyramid). Where
/// there is none at all: `otherwise`.
Image<float> filled(const Image<float>& inverse_depth, float otherwise);

/// A surface to sweep along.
struct Guide {
  Image<float> inverse_depth;      ///< 0: nothing is known
  Image<std::uint8_t> is_foreign;  ///< the plane is that of other pixels, not of the pixel's own depth
};

/// The planes of all pixels that enough of those around agree with; the others, which would spoil the windows
/// around them, get the plane of the nearest one that does, of several in equal distance the one with the
/// best score.
Guide guideOf(const DepthLayer& layer, const PlaneMap& planes);

/// For a level of twice the size: linear between values within `step` of each other, else the nearest.
DepthLayer doubled(const DepthLayer& layer, int width, int height, float step);

}  // namespace vdbfuse::stereo
