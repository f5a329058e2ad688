// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/extract.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

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

// The signs of a patch: bit z of row (x, y).
struct SignPatch {
  using Rows = std::array<std::uint16_t, kPatch * kPatch>;
  Rows inside, known;

  static std::size_t row(int x, int y) { return static_cast<std::size_t>(x * kPatch + y); }
  explicit SignPatch(const Patch& patch) {
    for (std::size_t r = 0; r < inside.size(); ++r) {
      const float* values = &patch.values[r * kPatch];
      unsigned in = 0, is = 0;
      for (unsigned z = 0; z < kPatch; ++z) {
        in |= static_cast<unsigned>(values[z] < 0) << z;  // not a number: false
        is |= static_cast<unsigned>(values[z] == values[z]) << z;
      }
      inside[r] = static_cast<std::uint16_t>(in), known[r] = static_cast<std::uint16_t>(is);
    }
  }

  /// The edges along an axis from the cells of a row, on which the sign changes between known values.
  unsigned changes(int axis, int x, int y) const {
    const std::size_t from = row(x, y);
    if (axis == 2) {
      const unsigned both = known[from] & (known[from] >> 1);
      return (inside[from] ^ (inside[from] >> 1)) & both & 0xff;
    }
    const std::size_t to = axis == 0 ? row(x + 1, y) : row(x, y + 1);
    return static_cast<unsigned>(inside[from] ^ inside[to]) & known[from] & known[to] & 0xff;
  }
  /// The cubes of a row that are known and that the surface crosses; those that are not known.
  struct Cubes {
    unsigned crossed, unknown;
  };
  Cubes cubes(int x, int y) const {
    unsigned all = ~0u, any = 0, is = ~0u;
    for (const std::size_t r : {row(x, y), row(x + 1, y), row(x, y + 1), row(x + 1, y + 1)})
      all &= inside[r], any |= inside[r], is &= known[r];
    const unsigned known_cubes = is & (is >> 1);
    return {(any | any >> 1) & ~(all & all >> 1) & known_cubes & 0xff, ~known_cubes & 0xff};
  }
  std::uint8_t caseOf(int x, int y, int z) const {
    unsigned corners = 0;
    for (int c = 0; c < 4; ++c) {
      const unsigned pair = inside[row(x + (c & 1), y + (c >> 1))] >> z & 3u;
      corners |= (pair & 1u) << c | (pair >> 1) << (c + 4);
    }
    return static_cast<std::uint8_t>(corners);
  }
};

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

constexpr std::uint32_t kExtra = 0x80000000u;
// The leaf itself and its seven upper neighbours, numbered like the corners of a cube.
using UpperLeaves = std::array<std::uint32_t, 8>;

// What one leaf contributes. Triangle corners at or above kExtra are the leaf's own centre vertices.
struct LeafMesh {
  UpperLeaves leaves;
  std::optional<SignPatch> signs;
  EdgeSet edges;
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> centres;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> rim;  ///< vertices on edges of cubes that were left out
};

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
  template <class Visit>
  void forEachLeaf(const Progress& progress, const char* name, const Visit& visit) {
    ProgressStep step(progress, name, meshes_.size());
    parallelFor(meshes_.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t leaf = begin; leaf < end; ++leaf) visit(leaf);
      step.advance(end - begin);
    });
  }

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
    LeafMesh& mesh = meshes_[index];
    mesh.leaves = upperLeaves(index);
    const Patch patch = loadPatch(mesh.leaves);
    const SignPatch& signs = mesh.signs.emplace(patch);
    const Index3 origin = field_.leaf(index).origin;
    for (int axis = 0; axis < 3; ++axis) {
      const Index3 step = Index3::Unit(axis);
      for (int row = 0; row < 64; ++row) {
        const int x = row >> 3, y = row & 7;
        for (unsigned edges = signs.changes(axis, x, y); edges != 0; edges &= edges - 1) {
          const int z = std::countr_zero(edges);
          const float a = patch.at(x, y, z), b = patch.at(x + step.x(), y + step.y(), z + step.z());
          mesh.edges.set(EdgeSet::place(axis, x, y, z));
          Eigen::Vector3d place = (origin + Index3(x, y, z)).cast<double>();
          place[axis] += std::clamp(a / (a - b), kMargin, 1 - kMargin);
          mesh.vertices.push_back(field_.frame().toWorld(place).cast<float>());
        }
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
    LeafMesh& mesh = meshes_[index];
    const SignPatch& signs = *mesh.signs;
    for (int row = 0; row < 64; ++row) {
      const int x = row >> 3, y = row & 7;
      const SignPatch::Cubes cubes = signs.cubes(x, y);
      for (unsigned left = cubes.unknown; left != 0; left &= left - 1)
        appendRim(signs, {x, y, std::countr_zero(left)}, mesh);
      for (unsigned crossed = cubes.crossed; crossed != 0; crossed &= crossed - 1) {
        const int z = std::countr_zero(crossed);
        for (const CubePolygon& polygon : cubePolygons(signs.caseOf(x, y, z)))
          addPolygon(polygon, {x, y, z}, mesh);
      }
    }
    mesh.signs.reset();
  }

  void appendRim(const SignPatch& signs, const Index3& cube, LeafMesh& mesh) const {
    const auto bit = [](const SignPatch::Rows& rows, const Index3& v) {
      return (rows[SignPatch::row(v.x(), v.y())] >> v.z() & 1) != 0;
    };
    for (std::uint8_t edge = 0; edge < cubeEdges().size(); ++edge) {
      const CubeEdge& e = cubeEdges()[edge];
      const Index3 base = cube + Index3(e.base & 1, e.base >> 1 & 1, e.base >> 2);
      const Index3 end = base + Index3(Index3::Unit(e.axis));
      if (!bit(signs.known, base) || !bit(signs.known, end)) continue;
      if (bit(signs.inside, base) != bit(signs.inside, end))
        mesh.rim.push_back(vertexOn(edge, cube, mesh.leaves));
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

  void addPolygon(const CubePolygon& polygon, const Index3& cube, LeafMesh& mesh) const {
    std::array<std::uint32_t, 13> vertices;
    for (const std::uint8_t edge : polygon.edges) vertices[edge] = vertexOn(edge, cube, mesh.leaves);
    if (polygon.has_centre) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const std::uint8_t edge : polygon.edges) sum += position(vertices[edge]);
      vertices[kCentre] = kExtra + static_cast<std::uint32_t>(mesh.centres.size());
      mesh.centres.push_back(sum / static_cast<float>(polygon.edges.size()));
    }
    for (const auto& t : polygon.triangles)
      mesh.triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  }

  // Vertices on edges come first, leaf by leaf, then those at centres.
  TriangleMesh merge() {
    std::vector<std::size_t> first_centre(meshes_.size()), first_triangle(meshes_.size());
    std::size_t vertices = 0, triangles = 0;
    for (const LeafMesh& mesh : meshes_) vertices += mesh.vertices.size();
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      first_centre[i] = vertices, first_triangle[i] = triangles;
      vertices += meshes_[i].centres.size(), triangles += meshes_[i].triangles.size();
    }
    TriangleMesh result;
    result.vertices.resize(vertices), result.triangles.resize(triangles);
    parallelFor(meshes_.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const LeafMesh& mesh = meshes_[i];
        std::copy(mesh.vertices.begin(), mesh.vertices.end(), result.vertices.data() + first_[i]);
        std::copy(mesh.centres.begin(), mesh.centres.end(), result.vertices.data() + first_centre[i]);
        Triangle* to = result.triangles.data() + first_triangle[i];
        for (Triangle triangle : mesh.triangles) {
          for (std::uint32_t& v : triangle)
            v = v < kExtra ? v : static_cast<std::uint32_t>(first_centre[i]) + (v - kExtra);
          *to++ = triangle;
        }
      }
    });
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
