// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mesh/triangle_mesh.h"

#include <Eigen/Geometry>

namespace vdbfuse {
namespace {

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

}  // namespace vdbfuse
