// SPDX-License-Identifier: Apache-2.0
// Small meshes with known truth, for the tests of every module. Counter-clockwise seen from outside.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse::test {

inline TriangleMesh octahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

/// Each triangle into four; vertices on the shared edges stay shared.
inline TriangleMesh subdivided(const TriangleMesh& mesh) {
  TriangleMesh fine;
  fine.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back(0.5f * (mesh.vertices[a] + mesh.vertices[b]));
    return entry->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}) {
      fine.triangles.push_back(t);
    }
  }
  return fine;
}

/// A sphere of 8·4^levels triangles, all vertices on it.
inline TriangleMesh sphere(double radius = 1.0, int levels = 4,
                           const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  TriangleMesh mesh = octahedron();
  for (int i = 0; i < levels; ++i) {
    mesh = subdivided(mesh);
    for (Eigen::Vector3f& v : mesh.vertices) v.normalize();
  }
  for (Eigen::Vector3f& v : mesh.vertices) v = (radius * v.cast<double>() + center).cast<float>();
  return mesh;
}

inline TriangleMesh box(const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.emplace_back((corner & 1 ? high : low).x(), (corner & 2 ? high : low).y(),
                               (corner & 4 ? high : low).z());
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Around the z axis, `around` × `across` quads of two triangles.
inline TriangleMesh torus(double ring_radius = 1.0, double tube_radius = 0.3, std::uint32_t around = 48,
                          std::uint32_t across = 24) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.push_back(
          Eigen::Vector3d(r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v)).cast<float>());
      const std::uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      const std::uint32_t a = i * across + j, b = i1 * across + j, c = i1 * across + j1, d = i * across + j1;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

/// The triangles whose three vertices have z ≥ 0: for a sphere the upper half, open at the equator.
inline TriangleMesh upperHalf(TriangleMesh mesh) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return mesh.vertices[v].z() < 0; });
  });
  return mesh;
}

/// The same surface, inside out.
inline TriangleMesh inverted(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// Both meshes in one; nothing is shared.
inline TriangleMesh joined(TriangleMesh a, const TriangleMesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

}  // namespace vdbfuse::test
