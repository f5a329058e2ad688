// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fusion/bit_image.h"
#include "vdbfuse/geometry/image.h"
#include "vdbfuse/geometry/projection.h"

namespace vdbfuse {

/// Neighbouring pixels belong to different surfaces when their depths differ by more than relative·depth +
/// absolute.
struct DepthEdge {
  float relative = 0.0f, absolute = 0.0f;
};

/// What a surface seen under 80° makes between diagonal neighbours, and a voxel: finer steps make no
/// difference to a grid.
DepthEdge depthEdge(const Projection& projection, double voxel);

/// Pixels at either side of a jump, or beside a patch of 3×3 pixels where nothing was measured (single
/// missing pixels make no edge): those pixels, those within one step of them and those within two. And pixels
/// that agree with none of the four beside them, but disagree with some: single wrong depths.
struct EdgeBands {
  BitImage at, within_one, within_two, lone;
};
EdgeBands edgeBands(const Image<float>& depth, const DepthEdge& edge);

}  // namespace vdbfuse
