// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/triangle_mesh.h"

#include <limits>

#include <Eigen/Geometry>

namespace vdbfuse {
namespace {

// Keeps element number[v] of every attribute where it is not kUnused.
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

template <class T>
void keep(const std::vector<std::uint32_t>& number, std::size_t count, std::vector<T>& values) {
  if (values.empty()) return;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] != kUnused) values[number[v]] = values[v];
  }
  values.resize(count);
}

struct Corners {
  Eigen::Vector3d a, b, c;
};

Corners corners(const TriangleMesh& mesh, const Triangle& t) {
  return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
          mesh.vertices[t[2]].cast<double>()};
}

}  // namespace

Box boundingBox(const TriangleMesh& mesh) {
  Box box;
  for (const Eigen::Vector3f& v : mesh.vertices) box.extend(v.cast<double>());
  return box;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Corners k = corners(mesh, t);
    sum += 0.5 * (k.b - k.a).cross(k.c - k.a).norm();
  }
  return sum;
}

std::vector<double> vertexAreas(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size(), 0.0);
  for (const Triangle& t : mesh.triangles) {
    const Corners k = corners(mesh, t);
    const double third = (k.b - k.a).cross(k.c - k.a).norm() / 6;
    for (const std::uint32_t v : t) areas[v] += third;
  }
  return areas;
}

double signedVolume(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Corners k = corners(mesh, t);
    sum += k.a.dot(k.b.cross(k.c)) / 6.0;
  }
  return sum;
}

std::vector<Eigen::Vector3f> vertexNormals(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> normals(mesh.vertices.size(), Eigen::Vector3f::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Corners k = corners(mesh, t);
    const Eigen::Vector3f weighted = (k.b - k.a).cross(k.c - k.a).cast<float>();
    for (const std::uint32_t v : t) normals[v] += weighted;
  }
  for (Eigen::Vector3f& n : normals) n.stableNormalize();
  return normals;
}

void dropUnusedVertices(TriangleMesh& mesh) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) number[v] = 0;
  }
  std::uint32_t count = 0;
  for (std::uint32_t& n : number) {
    if (n != kUnused) n = count++;
  }
  keep(number, count, mesh.vertices), keep(number, count, mesh.normals), keep(number, count, mesh.colors);
  keep(number, count, mesh.support), keep(number, count, mesh.confidence);
  for (Triangle& t : mesh.triangles) {
    for (std::uint32_t& v : t) v = number[v];
  }
}

std::uint32_t appendCopy(TriangleMesh& mesh, std::uint32_t vertex) {
  const auto copy = [vertex](auto& values) {
    if (!values.empty())
      values.push_back(typename std::decay_t<decltype(values)>::value_type(values[vertex]));
  };
  copy(mesh.normals), copy(mesh.colors), copy(mesh.support), copy(mesh.confidence), copy(mesh.vertices);
  return static_cast<std::uint32_t>(mesh.vertices.size()) - 1;
}

}  // namespace vdbfuse
