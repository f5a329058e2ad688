// SPDX-License-Identifier: Apache-2.0
// The parts of a surface that nobody measured, as a minimal surface in the Euclidean metric. The faces of a
// grid measure area in the L1 metric, in which a box is as good as a bowl; here the same energy (1) is
// minimised as a weighted total variation (variation.h), around the cut's surface and only where no depth map
// supports it. From coarse to fine: a level may move the cells that are at least as large in the octree.
#pragma once

#include <vector>

#include "surface/completion_start.h"
#include "vdbfuse/base/progress.h"
#include "vdbfuse/surface/field.h"

namespace vdbfuse {

class Completion {
 public:
  Completion(const CellPyramid& pyramid, std::vector<CompletionLevel> levels, const CompletionReport& report)
      : pyramid_(pyramid), levels_(std::move(levels)), report_(report) {}

  const CompletionReport& report() const { return report_; }
  /// Appends the origins, in grid coordinates, of the blocks of finest voxels around completed parts.
  void appendBlocksTo(std::vector<Index3>& origins) const;
  /// +1 outside, −1 inside of a block's voxels, wherever it is: from the finest level that knows it, else
  /// the label. REQUIRES: `origin` is a multiple of 8, grid coordinates, here and below.
  void readSides(const Index3& origin, float* sides) const;
  /// Signed distance to the completed surface, > 0 outside; kUnknown where it was not completed.
  void readDistances(const Index3& origin, float* distances) const;

 private:
  CellPyramid pyramid_;
  std::vector<CompletionLevel> levels_;  // finest first
  CompletionReport report_;
};

/// The same for every number of threads.
Completion completeSurface(const CellPyramid& pyramid, const CellTiles& tiles, const CompletionData& data,
                           const CompletionOptions& options, const Progress& progress = {});

}  // namespace vdbfuse
