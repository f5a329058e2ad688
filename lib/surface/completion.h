// SPDX-License-Identifier: Apache-2.0
// The parts of a surface that nobody measured, as a minimal surface in the Euclidean metric. The faces of a
// grid measure area in the L1 metric, in which a box is as good as a bowl; here the same energy (1) is
// minimised as a weighted total variation (variation.h), around the cut's surface and only where no depth map
// supports it.
#pragma once

#include <vector>

#include "surface/block_set.h"
#include "surface/cell_pyramid.h"
#include "vdbfuse/base/progress.h"
#include "vdbfuse/surface/field.h"

namespace vdbfuse {

/// u on blocks of one level, in cells of that level from the lowest corner of the octree's domain.
struct CompletionLevel {
  BlockSet blocks;
  std::vector<float> u;     ///< 1 inside, 0 outside, the surface at ½; 512 a block
  std::vector<float> free;  ///< 1 where u was found by the completion
};

class Completion {
 public:
  Completion(const CellPyramid& pyramid, std::vector<CompletionLevel> levels, CompletionReport report)
      : pyramid_(pyramid), levels_(std::move(levels)), report_(report) {}

  const CompletionReport& report() const { return report_; }
  /// Origins, in grid coordinates, of the blocks of finest voxels around completed parts.
  void appendBlocks(std::vector<Index3>& origins) const;
  /// +1 outside, −1 inside of a block's 512 voxels, wherever it is: from the finest level that knows it, else
  /// the label. REQUIRES: `origin` is a multiple of 8, grid coordinates, here and below.
  void readSides(const Index3& origin, float* sides) const;
  /// Signed distance to the completed surface, > 0 outside; kUnknown where it was not completed. False where
  /// none was.
  bool readDistances(const Index3& origin, float* distances) const;

 private:
  CellPyramid pyramid_;
  std::vector<CompletionLevel> levels_;
  CompletionReport report_;
};

/// `support`: C of the finest voxels; `measured`: signed distances at the voxels of blocks (512 each, origins
/// in grid coordinates), kUnknown where nothing was measured. The same for every number of threads.
Completion completeSurface(const CellPyramid& pyramid, const CellTiles& tiles, const ScalarGrid& support,
                           const BlockSet& blocks, const std::vector<float>& measured, float supported,
                           const CompletionOptions& options, const Progress& progress = {});

}  // namespace vdbfuse
