// SPDX-License-Identifier: Apache-2.0
// The signed field whose zero set is the surface: sign from the labels of the cut, sub-voxel position from
// the depth maps.
#pragma once

#include <optional>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/octree/graph.h"
#include "vdbfuse/octree/octree.h"
#include "vdbfuse/sensor/judged_view.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// The cells of the cut and what it found. References: arrays of octree.cellCount() values.
struct LabelledCells {
  const Octree& octree;
  const CellTiles& tiles;
  const std::vector<CellLabel>& labels;
  const std::vector<float>& support;  ///< C
  const std::vector<float>& sigma;
  CutOptions energy;
};

struct CompletionOptions {
  /// Isotropic: unsupported parts minimise (1) with Euclidean area. None: they stay as the cut left them, on
  /// the faces of cells.
  enum class Kind { Isotropic, None };
  Kind kind = Kind::Isotropic;
  /// The search ends when primal − dual falls below this share of the area, and the surface rests.
  double tolerance = 0.003;
  /// 25 iterations each, on each level.
  int max_rounds = 40;
};

/// The finest level of the completion. The minimum of the energy lies between dual and primal.
struct CompletionReport {
  double primal = 0, dual = 0;  ///< in faces of finest cells
  double area = 0;              ///< faces
  int iterations = 0;
};

struct FieldOptions {
  /// The largest standard deviation of the Gaussian that smooths what was measured, voxels: it is made as
  /// wide as the noise asks for, from 0.5 on. More is quieter and rounds edges. 0: no smoothing at all.
  double smoothing_voxels = 2.0;
  /// Fewer agreeing views than this do not support a surface.
  float supported = 0.3f;
  CompletionOptions completion;
  /// Components that fit into a cube of so many voxels go: narrower than the grid can show. 0: none.
  int least_width = 2;
};

struct SurfaceField {
  ScalarGrid distance;
  std::optional<CompletionReport> completion;
  std::size_t unresolved = 0;  ///< components that went because they were narrower than the grid shows
};

/// Grid "surface" on the finest voxels around the boundary between the labels; kUnknown further away. Signed
/// distance, > 0 outside, cut off at about two voxels. Where `support` (C of the finest voxels) holds, or
/// beside a voxel where it does: the mean of (D − d)·cos over the views that see this side of the surface,
/// weighted by reliability, incidence and precision; measured once more at the surface that this gives, and
/// smoothed as far as the noise asks for. Elsewhere the distance of the completed surface. Signs begin as the
/// labels; where something was measured or completed they follow the distance as long as that changes
/// neither components nor handles. Then components below the least width go: of a piece that the distances
/// deny, a voxel is left.
SurfaceField signedField(const JudgedViews& judged, const LabelledCells& cells, const ScalarGrid& support,
                         const FieldOptions& options = {}, const Progress& progress = {});

}  // namespace vdbfuse
