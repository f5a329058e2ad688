// SPDX-License-Identifier: Apache-2.0
#include "surface/label_blocks.h"

#include <algorithm>

#include "surface/block_set.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kTilesPerTask = 1024;

// Both layers of voxels along the face of a cell, widened by reach − 1.
void appendFace(const Octree& octree, std::size_t cell, int axis, int direction, int reach,
                std::vector<Index3>& out) {
  const int side = octree.side(cell);
  Index3 low = octree.lowest(cell), high = low.array() + (side - 1);
  low[axis] = direction > 0 ? high[axis] : low[axis] - 1;
  high[axis] = low[axis] + 1;
  appendBlocks(low.array() - (reach - 1), high.array() + (reach - 1), out);
}

void appendBorder(const Octree& octree, std::size_t cell, int reach, std::vector<Index3>& out) {
  const Index3 low = octree.lowest(cell) - octree.origin;
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] == 0) appendFace(octree, cell, axis, -1, reach, out);
    if (low[axis] + octree.side(cell) == octree.size[axis]) appendFace(octree, cell, axis, 1, reach, out);
  }
}

}  // namespace

std::vector<Index3> boundaryBlocks(const Octree& octree, const CellTiles& tiles,
                                   const std::vector<CellLabel>& labels, CellLabel beyond, int reach) {
  const auto append = [&](const CellFace& face, std::vector<Index3>& out) {
    if (labels[face.first] != labels[face.second])
      appendFace(octree, face.first, face.axis, face.direction, reach, out);
  };
  std::vector<std::vector<Index3>> parts(chunkCount(tiles.count(), kTilesPerTask));
  parallelFor(tiles.count(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Index3>& part = parts[begin / kTilesPerTask];
    forEachEqualFace(tiles, begin, end, [&](const CellFace& face) { append(face, part); });
    sortUniqueOrigins(part);
  });
  std::vector<Index3> all;
  for (const CellTransition& t : tiles.transitions) append(faceOf(tiles, t.fine, t.coarse, t.direction), all);
  for (std::size_t c = 0; c < labels.size(); ++c) {
    if (labels[c] != beyond) appendBorder(octree, c, reach, all);
  }
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  sortUniqueOrigins(all);
  return all;
}

void LabelReader::readBlock(const Index3& origin, CellLabel* out) const {
  if (!octree_.contains(origin)) {
    std::fill_n(out, ScalarGrid::kLeafSize, beyond_);
    return;
  }
  // A block is one aligned cube in Morton order: inside one coarse cell, or a run of consecutive cells.
  const std::size_t first = *octree_.find(origin);
  if (octree_.levels[first] >= 3) {
    std::fill_n(out, ScalarGrid::kLeafSize, labels_[first]);
    return;
  }
  const std::uint64_t end = mortonCode(origin - octree_.origin) + ScalarGrid::kLeafSize;
  for (std::size_t c = first; c < octree_.cellCount() && octree_.codes[c] < end; ++c) {
    const Index3 low = octree_.lowest(c) - origin;
    const int side = octree_.side(c);
    for (int x = 0; x < side; ++x) {
      for (int y = 0; y < side; ++y) {
        std::fill_n(out + ((low.x() + x) * 8 + low.y() + y) * 8 + low.z(), side, labels_[c]);
      }
    }
  }
}

}  // namespace vdbfuse
