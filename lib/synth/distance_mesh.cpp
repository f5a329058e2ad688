// SPDX-License-Identifier: Apache-2.0
#include "distance_mesh.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <limits>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse::synth {
namespace {

using Eigen::Vector3d;
using Node = std::array<int, 3>;

// A block of samples of the distance with its geometry; a cell is named by its lowest corner.
struct Lattice {
  Vector3d origin;
  double cell;
  Node size;
  std::vector<float> values;

  std::size_t index(const Node& n) const {
    return (static_cast<std::size_t>(n[2]) * size[1] + n[1]) * size[0] + n[0];
  }
  Vector3d position(const Node& n) const { return origin + cell * Vector3d(n[0], n[1], n[2]); }
  bool inside(const Node& n) const { return values[index(n)] < 0; }
};

Node corner(const Node& cell, int c) {
  return {cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)};
}

Lattice sample(const SignedDistance& distance, const Box& bounds, double cell) {
  constexpr double kMargin = 1.37;  // not a round number: faces of a box should not fall onto the lattice
  Lattice lattice{bounds.min() - Vector3d::Constant(kMargin * cell), cell, {}, {}};
  const Vector3d extent = bounds.sizes() / cell + Vector3d::Constant(2 * kMargin);
  for (int a = 0; a < 3; ++a) lattice.size[a] = static_cast<int>(std::ceil(extent[a])) + 1;
  const auto [nx, ny, nz] = lattice.size;
  lattice.values.resize(static_cast<std::size_t>(nx) * ny * nz);
  const std::size_t rows = static_cast<std::size_t>(ny) * nz;
  parallelFor(rows, ny, [&, nx = nx, ny = ny](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row % ny), z = static_cast<int>(row / ny);
      for (int x = 0; x < nx; ++x)
        lattice.values[row * nx + x] = static_cast<float>(distance(lattice.position({x, y, z})));
    }
  });
  return lattice;
}

bool crossesSurface(const Lattice& lattice, const Node& cell) {
  int inside = 0;
  for (int c = 0; c < 8; ++c) inside += lattice.inside(corner(cell, c)) ? 1 : 0;
  return inside != 0 && inside != 8;
}

Vector3d gradient(const SignedDistance& distance, const Vector3d& at, double step) {
  Vector3d g;
  for (int a = 0; a < 3; ++a) {
    const Vector3d d = step * Vector3d::Unit(a);
    g[a] = distance(at + d) - distance(at - d);
  }
  return g.normalized();
}

Vector3d crossing(const SignedDistance& distance, Vector3d inside, Vector3d outside) {
  constexpr int kBisections = 16;
  for (int i = 0; i < kBisections; ++i) {
    const Vector3d middle = 0.5 * (inside + outside);
    (distance(middle) < 0 ? inside : outside) = middle;
  }
  return 0.5 * (inside + outside);
}

// The point nearest to all tangent planes, taken from their centroid along well-determined directions only.
struct Planes {
  std::vector<std::pair<Vector3d, Vector3d>> planes;

  Vector3d bestPoint() const {
    constexpr double kDetermined = 0.1;
    Vector3d centroid = Vector3d::Zero();
    for (const auto& [point, normal] : planes) centroid += point / static_cast<double>(planes.size());
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const auto& [point, normal] : planes) {
      products += normal * normal.transpose();
      right += normal * normal.dot(point - centroid);
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(products);
    const Vector3d& values = solver.eigenvalues();
    Vector3d result = centroid;
    for (int i = 0; i < 3; ++i) {
      const Vector3d axis = solver.eigenvectors().col(i);
      if (values[i] > kDetermined * values[2]) result += axis * (axis.dot(right) / values[i]);
    }
    return result;
  }
};

Vector3d cellVertex(const SignedDistance& distance, const Lattice& lattice, const Node& cell) {
  Planes planes;
  for (int c = 0; c < 8; ++c) {
    for (int a = 0; a < 3; ++a) {
      if (c >> a & 1) continue;
      const Node from = corner(cell, c), to = corner(cell, c | 1 << a);
      const bool from_inside = lattice.inside(from);
      if (from_inside == lattice.inside(to)) continue;
      const Vector3d p = crossing(distance, lattice.position(from_inside ? from : to),
                                  lattice.position(from_inside ? to : from));
      planes.planes.emplace_back(p, gradient(distance, p, 1e-3 * lattice.cell));
    }
  }
  const Vector3d low = lattice.position(cell), high = low + Vector3d::Constant(lattice.cell);
  Vector3d vertex = planes.bestPoint().cwiseMax(low).cwiseMin(high);
  for (int i = 0; i < 3; ++i) vertex -= distance(vertex) * gradient(distance, vertex, 1e-3 * lattice.cell);
  return vertex.cwiseMax(low).cwiseMin(high);
}

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The cells that the surface crosses, and the number of each.
struct ActiveCells {
  std::vector<Node> cells;
  std::vector<std::uint32_t> number;
};

ActiveCells findActiveCells(const Lattice& lattice) {
  ActiveCells active;
  active.number.assign(lattice.values.size(), kNone);
  for (int z = 0; z + 1 < lattice.size[2]; ++z)
    for (int y = 0; y + 1 < lattice.size[1]; ++y)
      for (int x = 0; x + 1 < lattice.size[0]; ++x) {
        if (!crossesSurface(lattice, {x, y, z})) continue;
        active.number[lattice.index({x, y, z})] = static_cast<std::uint32_t>(active.cells.size());
        active.cells.push_back({x, y, z});
      }
  return active;
}

// The two triangles of a quad, cut along its shorter diagonal.
void addQuad(TriangleMesh& mesh, const std::array<std::uint32_t, 4>& q) {
  const auto length = [&](int a, int b) { return (mesh.vertices[q[a]] - mesh.vertices[q[b]]).squaredNorm(); };
  const int s = length(0, 2) <= length(1, 3) ? 0 : 1;
  mesh.triangles.push_back({q[s], q[s + 1], q[s + 2]});
  mesh.triangles.push_back({q[s], q[s + 2], q[(s + 3) % 4]});
}

// The quad around the lattice edge that leaves `node` along `axis`, through the four cells that share it.
void addQuadAround(TriangleMesh& mesh, const Lattice& lattice, const ActiveCells& active, const Node& node,
                   int axis) {
  Node to = node;
  ++to[axis];
  const bool inside = lattice.inside(node);
  if (inside == lattice.inside(to)) return;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::array<std::uint32_t, 4> quad;
  for (int k = 0; k < 4; ++k) {
    Node cell = node;
    cell[u] -= (k == 0 || k == 3) ? 1 : 0;
    cell[v] -= k < 2 ? 1 : 0;
    quad[inside ? k : 3 - k] = active.number[lattice.index(cell)];
  }
  addQuad(mesh, quad);
}

}  // namespace

TriangleMesh meshFromDistance(const SignedDistance& distance, const Box& bounds, double cell) {
  const Lattice lattice = sample(distance, bounds, cell);
  const ActiveCells active = findActiveCells(lattice);
  TriangleMesh mesh;
  mesh.vertices.resize(active.cells.size());
  parallelFor(active.cells.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      mesh.vertices[i] = cellVertex(distance, lattice, active.cells[i]).cast<float>();
  });
  mesh.triangles.reserve(2 * active.cells.size());
  for (const Node& node : active.cells)
    for (int axis = 0; axis < 3; ++axis) addQuadAround(mesh, lattice, active, node, axis);
  return mesh;
}

}  // namespace vdbfuse::synth
