// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kGrain = 1 << 14;

bool isDegenerate(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

void checkIndices(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t largest = *std::max_element(mesh.triangles[i].begin(), mesh.triangles[i].end());
    if (largest < mesh.vertices.size()) continue;
    throw InvalidArgument("mesh", "triangle " + std::to_string(i) + " names vertex " +
                                      std::to_string(largest) + " of " +
                                      std::to_string(mesh.vertices.size()));
  }
}

// The other two corners of a triangle, in its order, seen from one of its vertices.
struct Corner {
  std::uint32_t next, previous;
};

// The corners of the proper triangles, sorted by vertex: those of v are corners[first[v]] … corners[first[v +
// 1]].
struct VertexFans {
  std::vector<std::size_t> first;
  std::vector<Corner> corners;
};

VertexFans gatherFans(const TriangleMesh& mesh) {
  VertexFans fans;
  fans.first.assign(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    if (isDegenerate(t)) continue;
    for (const std::uint32_t v : t) ++fans.first[v + 1];
  }
  std::partial_sum(fans.first.begin(), fans.first.end(), fans.first.begin());
  fans.corners.resize(fans.first.back());
  std::vector<std::size_t> cursor(fans.first.begin(), fans.first.end() - 1);
  for (const Triangle& t : mesh.triangles) {
    if (isDegenerate(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) fans.corners[cursor[t[k]]++] = {t[(k + 1) % 3], t[(k + 2) % 3]};
  }
  return fans;
}

// One triangle's part in the edge from the vertex looked at to `other`.
struct Spoke {
  std::uint32_t other;
  std::uint32_t corner;
  bool outgoing;
};

// Looks at one vertex after the other and keeps its buffers.
class FanCounter {
 public:
  FanCounter(const VertexFans& fans, TopologyReport& counts) : fans_(fans), counts_(counts) {}

  void look(std::uint32_t vertex) {
    const std::size_t first = fans_.first[vertex], count = fans_.first[vertex + 1] - first;
    if (count == 0) return;
    ++counts_.used_vertices;
    collectSpokes(first, count);
    bool manifold = true;
    std::size_t edges = 0, open = 0;
    for (std::size_t begin = 0, end; begin < spokes_.size(); begin = end) {
      for (end = begin; end < spokes_.size() && spokes_[end].other == spokes_[begin].other; ++end) {
        join(spokes_[begin].corner, spokes_[end].corner);
      }
      ++edges;
      if (end - begin == 1) ++open;
      if (end - begin > 2) manifold = false;
      // Each edge is counted from its lower end.
      if (spokes_[begin].other > vertex) countEdge(begin, end);
    }
    if (open == 0 && edges < 3) manifold = false;
    if (!manifold || fanCount(count) != 1) ++counts_.nonmanifold_vertices;
  }

 private:
  void collectSpokes(std::size_t first, std::size_t count) {
    spokes_.clear();
    parent_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      parent_[i] = i;
      spokes_.push_back({fans_.corners[first + i].next, i, true});
      spokes_.push_back({fans_.corners[first + i].previous, i, false});
    }
    std::sort(spokes_.begin(), spokes_.end(),
              [](const Spoke& a, const Spoke& b) { return a.other < b.other; });
  }

  void countEdge(std::size_t begin, std::size_t end) {
    ++counts_.edges;
    if (end - begin == 1) ++counts_.open_edges;
    if (end - begin > 2) ++counts_.nonmanifold_edges;
    if (end - begin == 2 && spokes_[begin].outgoing == spokes_[begin + 1].outgoing)
      ++counts_.inconsistent_edges;
  }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }
  std::size_t fanCount(std::size_t count) const {
    std::size_t roots = 0;
    for (std::uint32_t i = 0; i < count; ++i) roots += parent_[i] == i;
    return roots;
  }

  const VertexFans& fans_;
  TopologyReport& counts_;
  std::vector<Spoke> spokes_;
  std::vector<std::uint32_t> parent_;
};

void countFans(const VertexFans& fans, TopologyReport& report) {
  const std::size_t vertices = fans.first.size() - 1;
  std::vector<TopologyReport> parts(chunkCount(vertices, kGrain));
  parallelFor(vertices, kGrain, [&](std::size_t begin, std::size_t end) {
    FanCounter counter(fans, parts[begin / kGrain]);
    for (std::size_t v = begin; v < end; ++v) counter.look(static_cast<std::uint32_t>(v));
  });
  for (const TopologyReport& part : parts) {
    report.used_vertices += part.used_vertices;
    report.edges += part.edges;
    report.open_edges += part.open_edges;
    report.nonmanifold_edges += part.nonmanifold_edges;
    report.inconsistent_edges += part.inconsistent_edges;
    report.nonmanifold_vertices += part.nonmanifold_vertices;
  }
}

bool hasArea(const TriangleMesh& mesh, const Triangle& t) {
  const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>();
  const Eigen::Vector3d b = mesh.vertices[t[1]].cast<double>(), c = mesh.vertices[t[2]].cast<double>();
  return !(b - a).cross(c - a).isZero(0.0);
}

void countTriangles(const TriangleMesh& mesh, TopologyReport& report) {
  for (const Triangle& t : mesh.triangles) {
    if (isDegenerate(t)) {
      ++report.degenerate_triangles;
      continue;
    }
    ++report.triangles;
    report.zero_area_triangles += !hasArea(mesh, t);
  }
}

std::size_t countComponents(const TriangleMesh& mesh, std::size_t used_vertices) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::size_t joined = 0;
  for (const Triangle& t : mesh.triangles) {
    if (isDegenerate(t)) continue;
    for (std::size_t k = 1; k < 3; ++k) {
      const std::uint32_t a = root(t[0]), b = root(t[k]);
      if (a == b) continue;
      parent[std::max(a, b)] = std::min(a, b);
      ++joined;
    }
  }
  return used_vertices - joined;
}

}  // namespace

TopologyReport topology(const TriangleMesh& mesh) {
  checkIndices(mesh);
  TopologyReport report;
  countTriangles(mesh, report);
  countFans(gatherFans(mesh), report);
  report.components = countComponents(mesh, report.used_vertices);
  report.euler_number = static_cast<std::ptrdiff_t>(report.used_vertices + report.triangles) -
                        static_cast<std::ptrdiff_t>(report.edges);
  for (const Eigen::Vector3f& v : mesh.vertices) report.nonfinite_vertices += !v.allFinite();
  return report;
}

bool isClosedManifold(const TopologyReport& report) {
  return report.triangles > 0 && report.open_edges == 0 && report.nonmanifold_edges == 0 &&
         report.inconsistent_edges == 0 && report.nonmanifold_vertices == 0 &&
         report.degenerate_triangles == 0 && report.nonfinite_vertices == 0;
}

}  // namespace vdbfuse
