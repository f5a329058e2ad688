// SPDX-License-Identifier: Apache-2.0
// Marching cubes leaf by leaf: what one leaf of 8³ voxels contributes to a mesh, for extractSurface(), which
// does them all, and LiveSurface, which does those that changed.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "vdbfuse/mesh/triangle_mesh.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// Values of a leaf and of its seven upper neighbours, numbered like the corners of a cube: bit 0 for x, bit
/// 1 for y, bit 2 for z. Null where there is none.
using UpperValues = std::array<const float*, 8>;
inline constexpr std::uint32_t kNoLeaf = 0xffffffff;
/// The same leaves by number; kNoLeaf where there is none.
using UpperLeaves = std::array<std::uint32_t, 8>;

/// A leaf and the next layer of its upper neighbours.
inline constexpr int kPatchSide = ScalarGrid::kLeafSide + 1;

/// The signs of a patch: bit z of row (x, y).
struct SignPatch {
  using Rows = std::array<std::uint16_t, kPatchSide * kPatchSide>;
  Rows inside, known;
};

/// Which of a leaf's 3 × 512 edges carry a vertex, and where the vertices of each word begin.
struct EdgeSet {
  std::array<std::uint64_t, 24> words{};
  std::array<std::uint16_t, 24> before{};

  static std::size_t place(int axis, int x, int y, int z) {
    return static_cast<std::size_t>(axis * 512 + (x * 8 + y) * 8 + z);
  }
  void set(std::size_t edge) { words[edge / 64] |= std::uint64_t{1} << (edge % 64); }
  void count() {
    std::uint16_t sum = 0;
    for (std::size_t w = 0; w < words.size(); ++w) {
      before[w] = sum;
      sum = static_cast<std::uint16_t>(sum + std::popcount(words[w]));
    }
  }
  std::uint32_t rank(std::size_t edge) const {
    const std::uint64_t lower = words[edge / 64] & ((std::uint64_t{1} << (edge % 64)) - 1);
    return before[edge / 64] + static_cast<std::uint32_t>(std::popcount(lower));
  }
};

/// A vertex of a leaf or of one of its upper neighbours; corner 8: the leaf's own centres.
struct VertexRef {
  std::uint8_t corner;
  std::uint16_t rank;
};

struct LeafMesh {
  SignPatch signs;
  EdgeSet edges;
  std::vector<Eigen::Vector3f> vertices;  ///< on the leaf's edges, in their order
  std::vector<Eigen::Vector3f> centres;   ///< of polygons that need a vertex in their middle
  std::vector<std::array<VertexRef, 3>> triangles;
  std::vector<VertexRef> rim;  ///< vertices on edges of cubes that were left out
};

/// The first step: signs and vertices.
LeafMesh placeVertices(const UpperValues& values, const Index3& origin, const GridFrame& frame);

/// The second: triangles and rim, once the vertices of the leaf and its upper neighbours are placed
/// (upper[0]: the leaf itself; null where there is none).
void connectTriangles(const std::array<const LeafMesh*, 8>& upper, LeafMesh& mesh);

/// The third: all leaves as one mesh, in their order, with manifold fans along the rim. Throws Error beyond
/// 2³¹ vertices.
TriangleMesh mergeLeaves(const std::vector<const LeafMesh*>& leaves, const std::vector<UpperLeaves>& upper);

}  // namespace vdbfuse
