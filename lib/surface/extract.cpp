// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/extract.h"

#include "surface/leaf_mesh.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kLeavesPerTask = 32;

template <class Visit>
void forEachLeaf(std::size_t count, const Progress& progress, const char* name, const Visit& visit) {
  ProgressStep step(progress, name, count);
  parallelFor(count, kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t leaf = begin; leaf < end; ++leaf) visit(leaf);
    step.advance(end - begin);
  });
}

UpperLeaves upperLeaves(const ScalarGrid& field, std::size_t leaf) {
  UpperLeaves result;
  const Index3 origin = field.leaf(leaf).origin;
  for (int c = 0; c < 8; ++c) {
    const auto found = field.findLeaf(origin + ScalarGrid::kLeafSide * Index3(c & 1, c >> 1 & 1, c >> 2));
    result[static_cast<std::size_t>(c)] = found ? static_cast<std::uint32_t>(*found) : kNoLeaf;
  }
  return result;
}

}  // namespace

TriangleMesh extractSurface(const ScalarGrid& field, const Progress& progress) {
  const std::size_t count = field.leafCount();
  std::vector<UpperLeaves> upper(count);
  std::vector<LeafMesh> meshes(count);
  forEachLeaf(count, progress, "place vertices", [&](std::size_t leaf) {
    upper[leaf] = upperLeaves(field, leaf);
    UpperValues values{};
    for (std::size_t c = 0; c < 8; ++c) {
      if (upper[leaf][c] != kNoLeaf) values[c] = field.leaf(upper[leaf][c]).values.data();
    }
    meshes[leaf] = placeVertices(values, field.leaf(leaf).origin, field.frame());
  });
  forEachLeaf(count, progress, "connect triangles", [&](std::size_t leaf) {
    std::array<const LeafMesh*, 8> around{};
    for (std::size_t c = 0; c < 8; ++c) {
      if (upper[leaf][c] != kNoLeaf) around[c] = &meshes[upper[leaf][c]];
    }
    connectTriangles(around, meshes[leaf]);
  });
  std::vector<const LeafMesh*> leaves;
  for (const LeafMesh& mesh : meshes) leaves.push_back(&mesh);
  return mergeLeaves(leaves, upper);
}

}  // namespace vdbfuse
