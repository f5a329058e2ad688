// SPDX-License-Identifier: Apache-2.0
#include "surface/boundary.h"

#include <cmath>

#include "surface/label_blocks.h"
#include "surface/smooth.h"

namespace vdbfuse {
namespace {

constexpr int kReach = 4;  // voxels around the boundary that are looked at

// The box of a block's voxels that have another side next to them; empty when there are none.
struct VoxelBox {
  Index3 low = Index3::Constant(8), high = Index3::Constant(-1);
  bool isEmpty() const { return high.x() < 0; }
};

VoxelBox boundaryIn(const BlockField& sides, std::size_t b) {
  PaddedBlock<1, 1> near;
  loadPadded(sides.blocks, sides.values.data(), b, 0.0f, near);
  VoxelBox box;
  for (int i = 0; i < static_cast<int>(kBlockSize); ++i) {
    const Index3 v = leafOffset(i);
    const float* own = &near.at(v.x(), v.y(), v.z());
    constexpr std::ptrdiff_t kX = PaddedBlock<1, 1>::kSide * PaddedBlock<1, 1>::kSide,
                             kY = PaddedBlock<1, 1>::kSide;
    for (const std::ptrdiff_t step : {-kX, kX, -kY, kY, std::ptrdiff_t{-1}, std::ptrdiff_t{1}}) {
      if (own[step] == -*own) box.low = box.low.cwiseMin(v), box.high = box.high.cwiseMax(v);
    }
  }
  return box;
}

// The block and its neighbours within reach of the boundary seen in it, there or not; none without one.
std::vector<Index3> reachedFrom(const BlockField& sides, std::size_t b) {
  constexpr int kMargin = 3;  // smoothing looks that far
  const VoxelBox box = boundaryIn(sides, b);
  std::vector<Index3> blocks;
  if (box.isEmpty()) return blocks;
  appendBlocks(sides.blocks.origin(b) + box.low - Index3::Constant(kMargin),
               sides.blocks.origin(b) + box.high + Index3::Constant(kMargin), blocks);
  return blocks;
}

}  // namespace

BlockField labelledSides(const LabelledCells& cells, CellLabel beyond) {
  BlockField sides{cells.octree.frame,
                   BlockSet(boundaryBlocks(cells.octree, cells.tiles, cells.labels, beyond, kReach)),
                   {}};
  sides.values.resize(sides.blocks.valueCount());
  const LabelReader reader(cells.octree, cells.labels, beyond);
  forEachBlock(sides.blocks.count(), [&](std::size_t b) {
    std::array<CellLabel, kBlockSize> labels;
    reader.readBlock(sides.blocks.origin(b), labels.data());
    std::transform(labels.begin(), labels.end(), sides.block(b),
                   [](CellLabel l) { return l == CellLabel::Outside ? 1.0f : -1.0f; });
  });
  return sides;
}

BlockField grownSides(const GridFrame& frame, std::vector<Index3> origins,
                      const std::function<void(const Index3& origin, float* sides)>& read) {
  BlockField sides{frame, BlockSet(std::move(origins)), {}};
  while (true) {
    sides.values.resize(sides.blocks.valueCount());
    forEachBlock(sides.blocks.count(), [&](std::size_t b) { read(sides.blocks.origin(b), sides.block(b)); });
    std::vector<std::vector<Index3>> parts(sides.blocks.count());
    forEachBlock(parts.size(), [&](std::size_t b) { parts[b] = reachedFrom(sides, b); });
    BlockSet reached(joined(parts));
    const bool is_complete =
        std::all_of(reached.origins().begin(), reached.origins().end(),
                    [&](const Index3& origin) { return sides.blocks.find(origin) != kNoBlock; });
    const bool is_same = is_complete && reached.count() == sides.blocks.count();
    if (is_same) return sides;
    sides.blocks = std::move(reached);
  }
}

std::vector<float> nearBoundary(const BlockField& sides) {
  // Both sides are there when a mean over them is neither +1 nor −1.
  std::vector<float> near = smoothed(sides.blocks, sides.values, 1.0);
  for (float& mean : near) mean = std::abs(mean) < 0.9999f ? 1.0f : 0.0f;
  return near;
}

void keepSupported(const BlockSet& blocks, const ScalarGrid& support, float supported,
                   std::vector<float>& marks) {
  std::vector<float> agreement(marks.size(), support.background());
  forEachBlock(blocks.count(), [&](std::size_t b) {
    if (const std::optional<std::size_t> leaf = support.findLeaf(blocks.origin(b))) {
      const ScalarGrid::Leaf values = support.leaf(*leaf);
      std::copy(values.values.begin(), values.values.end(), &agreement[b * kBlockSize]);
    }
  });
  forEachBlock(blocks.count(), [&](std::size_t b) {
    PaddedBlock<1, 1> c;
    loadPadded(blocks, agreement.data(), b, support.background(), c);
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      if (marks[b * kBlockSize + i] == 0) continue;
      const Index3 v = leafOffset(static_cast<int>(i));
      float largest = c.at(v);
      for (int n = 0; n < 6; ++n)
        largest = std::max(largest, c.at(v + (n % 2 * 2 - 1) * Index3(Index3::Unit(n / 2))));
      if (!(largest >= supported)) marks[b * kBlockSize + i] = 0;
    }
  });
}

void putBack(const BlockField& sides, float least, std::vector<float>& field) {
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (!(field[i] * sides.values[i] > 0)) field[i] = sides.values[i] * least;
  }
}

}  // namespace vdbfuse
