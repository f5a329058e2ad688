// SPDX-License-Identifier: Apache-2.0
// The photograph whose depths are looked for, at one level of its pyramid.
#pragma once

#include <vector>

#include "stereo/sweep_kernels.h"

namespace vdbfuse::stereo {

/// A level and the statistics of its windows.
struct ReferenceLevel {
  const PictureLevel* picture = nullptr;
  int radius = 3;
  Image<float> mean;
  /// 1/√(Σ(u − mean)²); 0 where the window leaves the picture or the mask, or has no texture.
  Image<float> inverse_spread;
};

/// `least_deviation`: of the brightness in a window, in [0, 1]; below it there is no texture.
ReferenceLevel referenceLevel(const PictureLevel& picture, int radius, float least_deviation);

/// Takes away the windows whose texture lies on their rim: less than a fiftieth of their variance is left in
/// the nine pixels of the middle, and what they see belongs to a surface that the pixel lies beside.
void leaveOutRims(ReferenceLevel& level);

struct TileRect {
  int x0 = 0, y0 = 0, width = 0, height = 0;
};

/// The level in tiles; those without any window are left out.
std::vector<TileRect> tilesOf(const ReferenceLevel& level);

/// What the sweep needs of a tile. `inverse_depth`: of the whole level; pixels beyond its border repeat the
/// last one.
void prepareTile(const ReferenceLevel& level, const TileRect& rect, const Image<float>& inverse_depth,
                 SweepTile& tile);
/// The same with one inverse depth everywhere.
void prepareTile(const ReferenceLevel& level, const TileRect& rect, float inverse_depth, SweepTile& tile);

}  // namespace vdbfuse::stereo
