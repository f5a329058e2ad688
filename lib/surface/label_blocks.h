// SPDX-License-Identifier: Apache-2.0
// The labels of an octree on the finest voxels, block by block, around the boundary between them.
#pragma once

#include <vector>

#include "vdbfuse/octree/graph.h"

namespace vdbfuse {

/// Origins of all 8³ blocks that hold a voxel within `reach` voxels of a face between different labels (or of
/// a face of the domain's border whose inner side differs from `beyond`). Sorted.
std::vector<Index3> boundaryBlocks(const Octree& octree, const CellTiles& tiles,
                                   const std::vector<CellLabel>& labels, CellLabel beyond, int reach);

/// Labels of one block's voxels in the order of ScalarGrid::Leaf.
class LabelReader {
 public:
  LabelReader(const Octree& octree, const std::vector<CellLabel>& labels, CellLabel beyond)
      : octree_(octree), labels_(labels), beyond_(beyond) {}
  CellLabel at(const Index3& voxel) const {
    const std::optional<std::size_t> cell = octree_.find(voxel);
    return cell ? labels_[*cell] : beyond_;
  }
  /// REQUIRES: `origin` is a multiple of 8.
  void readBlock(const Index3& origin, CellLabel* out) const;

 private:
  const Octree& octree_;
  const std::vector<CellLabel>& labels_;
  CellLabel beyond_;
};

}  // namespace vdbfuse
