// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/live_surface.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "surface/block_mesh.h"
#include "surface/leaf_mesh.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kLeavesPerTask = 32;
using LeafValues = std::array<float, ScalarGrid::kLeafSize>;

struct OriginBefore {
  bool operator()(const Index3& a, const Index3& b) const { return originBefore(a, b); }
};

Index3 upperStep(std::size_t corner) {
  return ScalarGrid::kLeafSide * Index3(corner & 1, corner >> 1 & 1, static_cast<int>(corner >> 2));
}

Index3 blockOf(const Index3& voxel) {
  constexpr int kMask = ~(LiveSurface::kBlockSide - 1);
  return {voxel.x() & kMask, voxel.y() & kMask, voxel.z() & kMask};
}

// The blocks that a change of a leaf's triangles shows in: of itself and its neighbours, by their normals.
void appendBlocksAround(const Index3& leaf, std::vector<Index3>& blocks) {
  constexpr int kStep = ScalarGrid::kLeafSide;
  const Index3 low = blockOf(leaf - Index3::Constant(kStep)), high = blockOf(leaf + Index3::Constant(kStep));
  for (int x = low.x(); x <= high.x(); x += LiveSurface::kBlockSide)
    for (int y = low.y(); y <= high.y(); y += LiveSurface::kBlockSide)
      for (int z = low.z(); z <= high.z(); z += LiveSurface::kBlockSide) blocks.emplace_back(x, y, z);
}

}  // namespace

struct LiveSurface::Impl {
  struct Leaf {
    Index3 origin;
    std::unique_ptr<LeafValues> values;
    UpperLeaves upper{};
    LeafMesh mesh;
  };

  GridFrame frame;
  std::map<Index3, std::uint32_t, OriginBefore> numbers;  ///< in the order of their origins
  std::vector<Leaf> leaves;                               ///< in the order in which they came
  std::vector<std::uint32_t> changed;
  std::size_t meshed = 0;
  std::vector<Index3> stale;             ///< blocks that changed since changedBlocks(), with repeats
  std::set<Index3, OriginBefore> given;  ///< blocks that have triangles, as changedBlocks() said

  std::uint32_t find(const Index3& origin) const {
    const auto found = numbers.find(origin);
    return found == numbers.end() ? kNoLeaf : found->second;
  }

  // Those leaves and the ones that look at them: whose upper neighbours they are.
  std::vector<std::uint32_t> withLower(const std::vector<std::uint32_t>& some) const {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t leaf : some) {
      for (std::size_t c = 0; c < 8; ++c) {
        const std::uint32_t lower = find(leaves[leaf].origin - upperStep(c));
        if (lower != kNoLeaf) result.push_back(lower);
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  template <class Visit>
  void forEach(const std::vector<std::uint32_t>& some, const Visit& visit) {
    parallelFor(some.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) visit(leaves[some[i]]);
    });
  }

  void place(Leaf& leaf) {
    UpperValues values{};
    for (std::size_t c = 0; c < 8; ++c) {
      leaf.upper[c] = find(leaf.origin + upperStep(c));
      if (leaf.upper[c] != kNoLeaf) values[c] = leaves[leaf.upper[c]].values->data();
    }
    leaf.mesh = placeVertices(values, leaf.origin, frame);
  }

  void connect(Leaf& leaf) {
    std::array<const LeafMesh*, 8> upper{};
    for (std::size_t c = 0; c < 8; ++c) {
      if (leaf.upper[c] != kNoLeaf) upper[c] = &leaves[leaf.upper[c]].mesh;
    }
    connectTriangles(upper, leaf.mesh);
  }

  void update() {
    const std::vector<std::uint32_t> placed = withLower(changed), connected = withLower(placed);
    forEach(placed, [&](Leaf& leaf) { place(leaf); });
    forEach(connected, [&](Leaf& leaf) { connect(leaf); });
    changed.clear();
    meshed = connected.size();
    for (const std::uint32_t leaf : connected) appendBlocksAround(leaves[leaf].origin, stale);
    sortUniqueOrigins(stale);
  }

  TriangleMesh meshOf(const Index3& block) const {
    const Index3 first = block - Index3::Constant(ScalarGrid::kLeafSide);
    BlockNeighbourhood around{};
    for (int x = 0; x < kAroundBlock; ++x) {
      for (int y = 0; y < kAroundBlock; ++y) {
        const Index3 column = first + ScalarGrid::kLeafSide * Index3(x, y, 0);
        const Index3 end = column + ScalarGrid::kLeafSide * Index3(0, 0, kAroundBlock);
        for (auto leaf = numbers.lower_bound(column); leaf != numbers.end() && originBefore(leaf->first, end);
             ++leaf) {
          const int z = (leaf->first.z() - first.z()) / ScalarGrid::kLeafSide;
          around[placeAround(x, y, z)] = &leaves[leaf->second].mesh;
        }
      }
    }
    return blockMesh(around);
  }

  std::vector<SurfaceBlock> changedBlocks() {
    std::vector<SurfaceBlock> blocks;
    for (const Index3& origin : stale) blocks.push_back({origin, {}});
    stale.clear();
    parallelFor(blocks.size(), 1,
                [&](std::size_t i, std::size_t) { blocks[i].mesh = meshOf(blocks[i].origin); });
    std::erase_if(blocks, [&](const SurfaceBlock& block) {
      return block.mesh.triangles.empty() && given.erase(block.origin) == 0;  // was empty before
    });
    for (const SurfaceBlock& block : blocks)
      if (!block.mesh.triangles.empty()) given.insert(block.origin);
    return blocks;
  }

  TriangleMesh merge() const {
    std::vector<const LeafMesh*> meshes;
    std::vector<std::uint32_t> rank(leaves.size() + 1, kNoLeaf);
    for (const auto& entry : numbers) {
      rank[entry.second] = static_cast<std::uint32_t>(meshes.size());
      meshes.push_back(&leaves[entry.second].mesh);
    }
    std::vector<UpperLeaves> upper;
    for (const auto& entry : numbers) {
      UpperLeaves& ranks = upper.emplace_back(leaves[entry.second].upper);
      for (std::uint32_t& leaf : ranks) leaf = leaf == kNoLeaf ? kNoLeaf : rank[leaf];
    }
    return mergeLeaves(meshes, upper);
  }
};

LiveSurface::LiveSurface(const GridFrame& frame) : impl_(std::make_unique<Impl>()) { impl_->frame = frame; }
LiveSurface::~LiveSurface() = default;
LiveSurface::LiveSurface(LiveSurface&&) noexcept = default;
LiveSurface& LiveSurface::operator=(LiveSurface&&) noexcept = default;

void LiveSurface::set(const Index3& origin, std::span<const float, ScalarGrid::kLeafSize> values) {
  const auto [entry, is_new] =
      impl_->numbers.try_emplace(origin, static_cast<std::uint32_t>(impl_->leaves.size()));
  if (is_new) impl_->leaves.push_back({origin, std::make_unique<LeafValues>(), {}, {}});
  std::copy(values.begin(), values.end(), impl_->leaves[entry->second].values->begin());
  impl_->changed.push_back(entry->second);
}

TriangleMesh LiveSurface::mesh() {
  impl_->update();
  return impl_->merge();
}

std::vector<SurfaceBlock> LiveSurface::changedBlocks() {
  impl_->update();
  return impl_->changedBlocks();
}

std::size_t LiveSurface::meshedLeaves() const { return impl_->meshed; }
std::size_t LiveSurface::leafCount() const { return impl_->leaves.size(); }

}  // namespace vdbfuse
