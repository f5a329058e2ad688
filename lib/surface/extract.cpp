// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/extract.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "surface/cube_cases.h"
#include "surface/split_rim.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr int kSide = ScalarGrid::kLeafSide;
constexpr int kPatch = kSide + 1;
constexpr std::size_t kLeavesPerTask = 32;
constexpr std::uint32_t kMissingLeaf = std::numeric_limits<std::uint32_t>::max();
// Vertices keep this distance from the ends of their edge, so that triangles keep an area.
constexpr float kMargin = 0.02f;

// A leaf's values with the next layer of its upper neighbours.
struct Patch {
  std::array<float, kPatch * kPatch * kPatch> values;
  float& at(int x, int y, int z) { return values[static_cast<std::size_t>((x * kPatch + y) * kPatch + z)]; }
  float at(int x, int y, int z) const {
    return values[static_cast<std::size_t>((x * kPatch + y) * kPatch + z)];
  }
};

bool isInside(float value) { return value < 0; }

// Which of a leaf's 3 × 512 edges carry a vertex, and where the vertices of each word begin.
struct EdgeSet {
  std::array<std::uint64_t, 24> words{};
  std::array<std::uint16_t, 24> before{};

  static std::size_t place(int axis, int x, int y, int z) {
    return static_cast<std::size_t>(axis * 512 + (x * kSide + y) * kSide + z);
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

// What one leaf contributes. Triangle corners at or above kExtra are the leaf's own centre vertices.
struct LeafMesh {
  EdgeSet edges;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> centres;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> rim;  ///< vertices on edges of cubes that were left out
};
constexpr std::uint32_t kExtra = 0x80000000u;

class Extractor {
 public:
  explicit Extractor(const ScalarGrid& field)
      : field_(field), meshes_(field.leafCount()), first_(field.leafCount()) {}

  TriangleMesh run(const Progress& progress) {
    forEachLeaf(progress, "place vertices", [&](std::size_t leaf) { placeVertices(leaf); });
    numberVertices();
    forEachLeaf(progress, "connect triangles", [&](std::size_t leaf) { connect(leaf); });
    return merge();
  }

 private:
  using UpperLeaves = std::array<std::uint32_t, 8>;

  template <class Visit>
  void forEachLeaf(const Progress& progress, const char* name, const Visit& visit) {
    ProgressStep step(progress, name, meshes_.size());
    parallelFor(meshes_.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf) visit(leaf);
      step.advance(end - begin);
    });
  }

  // The leaf itself and its seven upper neighbours, numbered like the corners of a cube.
  UpperLeaves upperLeaves(std::size_t leaf) const {
    UpperLeaves result;
    const Index3 origin = field_.leaf(leaf).origin;
    for (int c = 0; c < 8; ++c) {
      const auto found = field_.findLeaf(origin + kSide * Index3(c & 1, c >> 1 & 1, c >> 2));
      result[static_cast<std::size_t>(c)] = found ? static_cast<std::uint32_t>(*found) : kMissingLeaf;
    }
    return result;
  }

  Patch loadPatch(const UpperLeaves& leaves) const {
    Patch patch;
    patch.values.fill(kUnknown);
    for (int c = 0; c < 8; ++c) {
      if (leaves[static_cast<std::size_t>(c)] == kMissingLeaf) continue;
      const ScalarGrid::Leaf leaf = field_.leaf(leaves[static_cast<std::size_t>(c)]);
      const Index3 offset = kSide * Index3(c & 1, c >> 1 & 1, c >> 2);
      for (int x = 0; x < (c & 1 ? 1 : kSide); ++x) {
        for (int y = 0; y < (c >> 1 & 1 ? 1 : kSide); ++y) {
          for (int z = 0; z < (c >> 2 ? 1 : kSide); ++z) {
            patch.at(x + offset.x(), y + offset.y(), z + offset.z()) = leaf.at(x, y, z);
          }
        }
      }
    }
    return patch;
  }

  void placeVertices(std::size_t index) {
    const Patch patch = loadPatch(upperLeaves(index));
    const Index3 origin = field_.leaf(index).origin;
    LeafMesh& mesh = meshes_[index];
    for (int axis = 0; axis < 3; ++axis) {
      const Index3 step = Index3::Unit(axis);
      for (int i = 0; i < 512; ++i) {
        const int x = i >> 6, y = i >> 3 & 7, z = i & 7;
        const float a = patch.at(x, y, z), b = patch.at(x + step.x(), y + step.y(), z + step.z());
        if (std::isnan(a) || std::isnan(b) || isInside(a) == isInside(b)) continue;
        mesh.edges.set(EdgeSet::place(axis, x, y, z));
        Eigen::Vector3d place = (origin + Index3(x, y, z)).cast<double>();
        place[axis] += std::clamp(a / (a - b), kMargin, 1 - kMargin);
        mesh.vertices.push_back(field_.frame().toWorld(place).cast<float>());
      }
    }
    mesh.edges.count();
  }

  void numberVertices() {
    std::size_t next = 0;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      first_[i] = static_cast<std::uint32_t>(next);
      next += meshes_[i].vertices.size();
    }
    if (next >= kExtra) throw Error("the surface has more than 2^31 vertices; use larger voxels");
  }

  void connect(std::size_t index) {
    const UpperLeaves leaves = upperLeaves(index);
    const Patch patch = loadPatch(leaves);
    for (int i = 0; i < 512; ++i) {
      const Index3 cube = leafOffset(i);
      unsigned inside = 0;
      bool known = true;
      for (int c = 0; c < 8 && known; ++c) {
        const float value = patch.at(cube.x() + (c & 1), cube.y() + (c >> 1 & 1), cube.z() + (c >> 2));
        known = !std::isnan(value);
        inside |= static_cast<unsigned>(isInside(value)) << c;
      }
      if (!known) appendRim(patch, cube, leaves, meshes_[index].rim);
      if (!known || inside == 0 || inside == 255) continue;
      for (const CubePolygon& polygon : cubePolygons(static_cast<std::uint8_t>(inside))) {
        addPolygon(polygon, cube, leaves, meshes_[index]);
      }
    }
  }

  void appendRim(const Patch& patch, const Index3& cube, const UpperLeaves& leaves,
                 std::vector<std::uint32_t>& rim) const {
    for (std::uint8_t edge = 0; edge < cubeEdges().size(); ++edge) {
      const CubeEdge& e = cubeEdges()[edge];
      const Index3 base = cube + Index3(e.base & 1, e.base >> 1 & 1, e.base >> 2);
      const Index3 end = base + Index3(Index3::Unit(e.axis));
      const float a = patch.at(base.x(), base.y(), base.z()), b = patch.at(end.x(), end.y(), end.z());
      if (std::isnan(a) || std::isnan(b) || isInside(a) == isInside(b)) continue;
      rim.push_back(vertexOn(edge, cube, leaves));
    }
  }

  std::vector<std::uint32_t> rimVertices() const {
    std::vector<std::uint32_t> all;
    for (const LeafMesh& mesh : meshes_) all.insert(all.end(), mesh.rim.begin(), mesh.rim.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  std::uint32_t vertexOn(std::uint8_t edge, const Index3& cube, const UpperLeaves& leaves) const {
    const CubeEdge& e = cubeEdges()[edge];
    const Index3 base = cube + Index3(e.base & 1, e.base >> 1 & 1, e.base >> 2);
    const std::size_t neighbour =
        static_cast<std::size_t>((base.x() >> 3) | (base.y() >> 3) << 1 | (base.z() >> 3) << 2);
    const std::size_t leaf = leaves[neighbour];
    return first_[leaf] +
           meshes_[leaf].edges.rank(EdgeSet::place(e.axis, base.x() & 7, base.y() & 7, base.z() & 7));
  }

  Eigen::Vector3f position(std::uint32_t vertex) const {
    const auto after = std::upper_bound(first_.begin(), first_.end(), vertex);
    const std::size_t leaf = static_cast<std::size_t>(after - first_.begin()) - 1;
    return meshes_[leaf].vertices[vertex - first_[leaf]];
  }

  void addPolygon(const CubePolygon& polygon, const Index3& cube, const UpperLeaves& leaves,
                  LeafMesh& mesh) const {
    std::array<std::uint32_t, 13> vertices{};
    for (const std::uint8_t edge : polygon.edges) vertices[edge] = vertexOn(edge, cube, leaves);
    if (polygon.has_centre) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const std::uint8_t edge : polygon.edges) sum += position(vertices[edge]);
      vertices[kCentre] = kExtra + static_cast<std::uint32_t>(mesh.centres.size());
      mesh.centres.push_back(sum / static_cast<float>(polygon.edges.size()));
    }
    for (const auto& t : polygon.triangles)
      mesh.triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  }

  TriangleMesh merge() {
    TriangleMesh result;
    for (const LeafMesh& mesh : meshes_) {
      result.vertices.insert(result.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    }
    for (LeafMesh& mesh : meshes_) {
      const std::uint32_t first_centre = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.insert(result.vertices.end(), mesh.centres.begin(), mesh.centres.end());
      for (Triangle triangle : mesh.triangles) {
        for (std::uint32_t& v : triangle) v = v < kExtra ? v : first_centre + (v - kExtra);
        result.triangles.push_back(triangle);
      }
    }
    splitFans(result, rimVertices());
    dropUnusedVertices(result);
    return result;
  }

  const ScalarGrid& field_;
  std::vector<LeafMesh> meshes_;
  std::vector<std::uint32_t> first_;
};

}  // namespace

TriangleMesh extractSurface(const ScalarGrid& field, const Progress& progress) {
  return Extractor(field).run(progress);
}

}  // namespace vdbfuse
