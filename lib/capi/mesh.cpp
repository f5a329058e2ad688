// SPDX-License-Identifier: Apache-2.0
#include <cstddef>

#include "capi/handles.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/topology.h"

using namespace vdbfuse;
using namespace vdbfuse::capi;

namespace {

// In version 1 of the interface.
constexpr std::size_t kTopologyBytes = offsetof(vdbfuse_topology, reserved) + sizeof(std::int32_t);

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float) && sizeof(Triangle) == 3 * sizeof(std::uint32_t) &&
              sizeof(Rgb8) == 3);

// The numbers of an attribute one after the other; NULL where there is none.
template <class Number, class Value>
const Number* numbersOf(const std::vector<Value>& values) {
  return values.empty() ? nullptr : values.front().data();
}

}  // namespace

size_t vdbfuse_mesh_vertex_count(const vdbfuse_mesh* mesh) {
  return mesh == nullptr ? 0 : mesh->mesh.vertices.size();
}
size_t vdbfuse_mesh_triangle_count(const vdbfuse_mesh* mesh) {
  return mesh == nullptr ? 0 : mesh->mesh.triangles.size();
}
const float* vdbfuse_mesh_vertices(const vdbfuse_mesh* mesh) {
  return mesh == nullptr ? nullptr : numbersOf<float>(mesh->mesh.vertices);
}
const uint32_t* vdbfuse_mesh_triangles(const vdbfuse_mesh* mesh) {
  return mesh == nullptr ? nullptr : numbersOf<uint32_t>(mesh->mesh.triangles);
}
const float* vdbfuse_mesh_normals(const vdbfuse_mesh* mesh) {
  return mesh == nullptr ? nullptr : numbersOf<float>(mesh->mesh.normals);
}
const uint8_t* vdbfuse_mesh_colors(const vdbfuse_mesh* mesh) {
  return mesh == nullptr ? nullptr : numbersOf<uint8_t>(mesh->mesh.colors);
}
const float* vdbfuse_mesh_support(const vdbfuse_mesh* mesh) {
  return mesh == nullptr || mesh->mesh.support.empty() ? nullptr : mesh->mesh.support.data();
}

vdbfuse_status vdbfuse_mesh_write(const vdbfuse_mesh* mesh, const char* path) {
  return guarded([&] {
    requireNotNull(mesh, "mesh");
    requireNotNull(path, "path");
    writeMesh(path, mesh->mesh);
  });
}

vdbfuse_status vdbfuse_mesh_topology(const vdbfuse_mesh* mesh, vdbfuse_topology* out) {
  return guarded([&] {
    requireNotNull(mesh, "mesh");
    requireNotNull(out, "topology");
    const TopologyReport report = topology(mesh->mesh);
    writeStruct({0, report.components, report.open_edges, report.nonmanifold_edges, report.euler_number,
                 isClosedManifold(report) ? 1 : 0, 0},
                out->struct_size, kTopologyBytes, "topology", out);
  });
}

void vdbfuse_mesh_destroy(vdbfuse_mesh* mesh) { delete mesh; }
