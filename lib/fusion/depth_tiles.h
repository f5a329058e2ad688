// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

/// The nearest and furthest depth of each tile of 8×8 pixels; most = 0 where nothing was measured, and least
/// is infinite there.
struct DepthTiles {
  static constexpr int kSide = 8;
  Image<float> least, most;

  explicit DepthTiles(const Image<float>& depth);

  struct Range {
    float least, most;
  };
  /// Over all tiles that hold pixels of [x0, x1] × [y0, y1], which may lie outside the image in part.
  Range over(float x0, float y0, float x1, float y1) const;
};

}  // namespace vdbfuse
