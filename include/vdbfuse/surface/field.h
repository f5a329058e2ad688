// SPDX-License-Identifier: Apache-2.0
// The signed field whose zero set is the surface: sign from the labels of the cut, sub-voxel position from
// the depth maps.
#pragma once

#include "vdbfuse/base/progress.h"
#include "vdbfuse/octree/graph.h"
#include "vdbfuse/octree/octree.h"
#include "vdbfuse/sensor/judged_view.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

struct FieldOptions {
  /// Standard deviation of the Gaussian that smooths the field, voxels. More rounds edges.
  double smoothing_voxels = 1.0;
  /// Fewer agreeing views than this do not support a surface.
  float supported = 0.3f;
  /// What lies beyond the domain.
  CellLabel beyond = CellLabel::Outside;
};

/// Grid "surface" on the finest voxels around the boundary between the labels; kUnknown further away. Signed
/// distance, > 0 outside, cut off at two voxels. Its sign equals the label of every voxel. Where `support`
/// (C) holds, the distance is the mean of (D − d)·cos over the views that see this side of the surface,
/// weighted by reliability, incidence and precision; elsewhere half a voxel to the label's side.
ScalarGrid signedField(const JudgedViews& judged, const Octree& octree, const CellTiles& tiles,
                       const std::vector<CellLabel>& labels, const ScalarGrid& support,
                       const FieldOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
