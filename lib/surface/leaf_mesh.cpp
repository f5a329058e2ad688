// SPDX-License-Identifier: Apache-2.0
#include "surface/leaf_mesh.h"

#include <algorithm>
#include <limits>

#include "surface/cube_cases.h"
#include "surface/split_rim.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr int kSide = ScalarGrid::kLeafSide;
constexpr std::size_t kLeavesPerTask = 32;
constexpr std::uint32_t kMostVertices = 0x80000000u;
// Vertices keep this distance from the ends of their edge, so that triangles keep an area.
constexpr float kMargin = 0.02f;
constexpr std::uint8_t kOwnCentre = 8;

// A leaf's values with the next layer of its upper neighbours.
struct Patch {
  std::array<float, kPatchSide * kPatchSide * kPatchSide> values;

  explicit Patch(const UpperValues& leaves) {
    values.fill(kUnknown);
    for (int c = 0; c < 8; ++c) {
      const float* from = leaves[static_cast<std::size_t>(c)];
      if (from == nullptr) continue;
      const Index3 offset = kSide * Index3(c & 1, c >> 1 & 1, c >> 2);
      for (int x = 0; x < (c & 1 ? 1 : kSide); ++x) {
        for (int y = 0; y < (c >> 1 & 1 ? 1 : kSide); ++y) {
          for (int z = 0; z < (c >> 2 ? 1 : kSide); ++z)
            at(x + offset.x(), y + offset.y(), z + offset.z()) = from[(x * kSide + y) * kSide + z];
        }
      }
    }
  }
  float& at(int x, int y, int z) {
    return values[static_cast<std::size_t>((x * kPatchSide + y) * kPatchSide + z)];
  }
  float at(int x, int y, int z) const {
    return values[static_cast<std::size_t>((x * kPatchSide + y) * kPatchSide + z)];
  }
};

std::size_t rowOf(int x, int y) { return static_cast<std::size_t>(x * kPatchSide + y); }

SignPatch signsOf(const Patch& patch) {
  SignPatch signs;
  for (std::size_t r = 0; r < signs.inside.size(); ++r) {
    const float* values = &patch.values[r * kPatchSide];
    unsigned in = 0, is = 0;
    for (unsigned z = 0; z < kPatchSide; ++z) {
      in |= static_cast<unsigned>(values[z] < 0) << z;  // not a number: false
      is |= static_cast<unsigned>(values[z] == values[z]) << z;
    }
    signs.inside[r] = static_cast<std::uint16_t>(in);
    signs.known[r] = static_cast<std::uint16_t>(is);
  }
  return signs;
}

// The edges along an axis from the cells of a row, on which the sign changes between known values.
unsigned signChanges(const SignPatch& signs, int axis, int x, int y) {
  const std::size_t from = rowOf(x, y);
  if (axis == 2) {
    const unsigned both = signs.known[from] & (signs.known[from] >> 1);
    return (signs.inside[from] ^ (signs.inside[from] >> 1)) & both & 0xff;
  }
  const std::size_t to = axis == 0 ? rowOf(x + 1, y) : rowOf(x, y + 1);
  return static_cast<unsigned>(signs.inside[from] ^ signs.inside[to]) & signs.known[from] & signs.known[to] &
         0xff;
}

// The cubes of a row that are known and that the surface crosses; those with an unknown corner that have both
// signs at the others.
struct RowCubes {
  unsigned crossed, left_out;
};
RowCubes rowCubes(const SignPatch& signs, int x, int y) {
  unsigned in = 0, out = 0, is = ~0u;
  for (const std::size_t r : {rowOf(x, y), rowOf(x + 1, y), rowOf(x, y + 1), rowOf(x + 1, y + 1)}) {
    in |= signs.inside[r], is &= signs.known[r];
    out |= signs.known[r] & ~static_cast<unsigned>(signs.inside[r]);
  }
  const unsigned known_cubes = is & (is >> 1), both = (in | in >> 1) & (out | out >> 1) & 0xff;
  return {both & known_cubes, both & ~known_cubes};
}

std::uint8_t cubeCase(const SignPatch& signs, const Index3& cube) {
  unsigned corners = 0;
  for (int c = 0; c < 4; ++c) {
    const unsigned pair = signs.inside[rowOf(cube.x() + (c & 1), cube.y() + (c >> 1))] >> cube.z() & 3u;
    corners |= (pair & 1u) << c | (pair >> 1) << (c + 4);
  }
  return static_cast<std::uint8_t>(corners);
}

// Makes the triangles of one leaf.
class Connector {
 public:
  Connector(const std::array<const LeafMesh*, 8>& upper, LeafMesh& mesh) : upper_(upper), mesh_(mesh) {}

  void run() {
    mesh_.triangles.clear(), mesh_.centres.clear(), mesh_.rim.clear();
    for (int row = 0; row < 64; ++row) {
      const int x = row >> 3, y = row & 7;
      const RowCubes cubes = rowCubes(mesh_.signs, x, y);
      for (unsigned left = cubes.left_out; left != 0; left &= left - 1)
        appendRim({x, y, std::countr_zero(left)});
      for (unsigned crossed = cubes.crossed; crossed != 0; crossed &= crossed - 1) {
        const Index3 cube(x, y, std::countr_zero(crossed));
        for (const CubePolygon& polygon : cubePolygons(cubeCase(mesh_.signs, cube)))
          addPolygon(polygon, cube);
      }
    }
  }

 private:
  void appendRim(const Index3& cube) {
    const auto bit = [](const SignPatch::Rows& rows, const Index3& v) {
      return (rows[rowOf(v.x(), v.y())] >> v.z() & 1) != 0;
    };
    for (std::uint8_t edge = 0; edge < cubeEdges().size(); ++edge) {
      const CubeEdge& e = cubeEdges()[edge];
      const Index3 base = cube + Index3(e.base & 1, e.base >> 1 & 1, e.base >> 2);
      const Index3 end = base + Index3(Index3::Unit(e.axis));
      if (!bit(mesh_.signs.known, base) || !bit(mesh_.signs.known, end)) continue;
      if (bit(mesh_.signs.inside, base) != bit(mesh_.signs.inside, end))
        mesh_.rim.push_back(vertexOn(edge, cube));
    }
  }

  VertexRef vertexOn(std::uint8_t edge, const Index3& cube) const {
    const CubeEdge& e = cubeEdges()[edge];
    const Index3 base = cube + Index3(e.base & 1, e.base >> 1 & 1, e.base >> 2);
    const int corner = (base.x() >> 3) | (base.y() >> 3) << 1 | (base.z() >> 3) << 2;
    const std::size_t place = EdgeSet::place(e.axis, base.x() & 7, base.y() & 7, base.z() & 7);
    return {static_cast<std::uint8_t>(corner),
            static_cast<std::uint16_t>(upper_[static_cast<std::size_t>(corner)]->edges.rank(place))};
  }

  const Eigen::Vector3f& position(const VertexRef& vertex) const {
    return upper_[vertex.corner]->vertices[vertex.rank];
  }

  void addPolygon(const CubePolygon& polygon, const Index3& cube) {
    std::array<VertexRef, 13> vertices;
    for (const std::uint8_t edge : polygon.edges) vertices[edge] = vertexOn(edge, cube);
    if (polygon.has_centre) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const std::uint8_t edge : polygon.edges) sum += position(vertices[edge]);
      vertices[kCentre] = {kOwnCentre, static_cast<std::uint16_t>(mesh_.centres.size())};
      mesh_.centres.push_back(sum / static_cast<float>(polygon.edges.size()));
    }
    for (const auto& t : polygon.triangles)
      mesh_.triangles.push_back({vertices[t[0]], vertices[t[1]], vertices[t[2]]});
  }

  const std::array<const LeafMesh*, 8>& upper_;
  LeafMesh& mesh_;
};

// Where each leaf's vertices, centres and triangles begin in the whole mesh: vertices on edges first, leaf by
// leaf, then those at centres.
struct Offsets {
  std::vector<std::uint32_t> vertex, centre;
  std::vector<std::size_t> triangle;
  std::size_t vertices = 0, triangles = 0;

  explicit Offsets(const std::vector<const LeafMesh*>& leaves)
      : vertex(leaves.size()), centre(leaves.size()), triangle(leaves.size()) {
    for (const LeafMesh* leaf : leaves) vertices += leaf->vertices.size() + leaf->centres.size();
    if (vertices >= kMostVertices) throw Error("the surface has more than 2^31 vertices; use larger voxels");
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      vertex[i] = next, triangle[i] = triangles;
      next += static_cast<std::uint32_t>(leaves[i]->vertices.size()),
          triangles += leaves[i]->triangles.size();
    }
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      centre[i] = next;
      next += static_cast<std::uint32_t>(leaves[i]->centres.size());
    }
  }
};

}  // namespace

LeafMesh placeVertices(const UpperValues& values, const Index3& origin, const GridFrame& frame) {
  const Patch patch(values);
  LeafMesh mesh;
  mesh.signs = signsOf(patch);
  for (int axis = 0; axis < 3; ++axis) {
    const Index3 step = Index3::Unit(axis);
    for (int row = 0; row < 64; ++row) {
      const int x = row >> 3, y = row & 7;
      for (unsigned edges = signChanges(mesh.signs, axis, x, y); edges != 0; edges &= edges - 1) {
        const int z = std::countr_zero(edges);
        const float a = patch.at(x, y, z), b = patch.at(x + step.x(), y + step.y(), z + step.z());
        mesh.edges.set(EdgeSet::place(axis, x, y, z));
        Eigen::Vector3d place = (origin + Index3(x, y, z)).cast<double>();
        place[axis] += std::clamp(a / (a - b), kMargin, 1 - kMargin);
        mesh.vertices.push_back(frame.toWorld(place).cast<float>());
      }
    }
  }
  mesh.edges.count();
  return mesh;
}

void connectTriangles(const std::array<const LeafMesh*, 8>& upper, LeafMesh& mesh) {
  Connector(upper, mesh).run();
}

TriangleMesh mergeLeaves(const std::vector<const LeafMesh*>& leaves, const std::vector<UpperLeaves>& upper) {
  const Offsets offsets(leaves);
  const auto numbered = [&](std::size_t leaf, const VertexRef& vertex) {
    if (vertex.corner == kOwnCentre) return offsets.centre[leaf] + vertex.rank;
    return offsets.vertex[upper[leaf][vertex.corner]] + vertex.rank;
  };
  TriangleMesh result;
  result.vertices.resize(offsets.vertices), result.triangles.resize(offsets.triangles);
  std::vector<std::vector<std::uint32_t>> rims(chunkCount(leaves.size(), kLeavesPerTask));
  parallelFor(leaves.size(), kLeavesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const LeafMesh& mesh = *leaves[i];
      std::copy(mesh.vertices.begin(), mesh.vertices.end(), result.vertices.data() + offsets.vertex[i]);
      std::copy(mesh.centres.begin(), mesh.centres.end(), result.vertices.data() + offsets.centre[i]);
      Triangle* to = result.triangles.data() + offsets.triangle[i];
      for (const auto& t : mesh.triangles) *to++ = {numbered(i, t[0]), numbered(i, t[1]), numbered(i, t[2])};
      for (const VertexRef& v : mesh.rim) rims[begin / kLeavesPerTask].push_back(numbered(i, v));
    }
  });
  std::vector<std::uint32_t> rim;
  for (const auto& part : rims) rim.insert(rim.end(), part.begin(), part.end());
  std::sort(rim.begin(), rim.end());
  rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
  splitFans(result, rim);
  dropUnusedVertices(result);
  return result;
}

}  // namespace vdbfuse
