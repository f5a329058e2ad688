// SPDX-License-Identifier: Apache-2.0
#include "python/mesh.h"

#include <cstring>
#include <filesystem>
#include <optional>
#include <type_traits>

#include "python/arrays.h"
#include "python/module.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/report/grid_levels.h"
#include "vdbfuse/report/slice.h"
#include "vdbfuse/surface/simplify.h"
#include "vdbfuse/surface/trim.h"

namespace vdbfuse::python {
namespace {

using MeshPointer = std::shared_ptr<Mesh>;
using Unlocked = py::call_guard<py::gil_scoped_release>;

// The array of a member of the mesh, or None where it is empty and not every mesh has it.
template <class T, class Number>
py::object members(const py::object& self, const std::vector<T>& values, const Number* first,
                   py::ssize_t columns) {
  const auto rows = static_cast<py::ssize_t>(values.size());
  if (columns == 1) return readOnlyArray(self, {rows}, first);
  return readOnlyArray(self, {rows, columns}, first);
}

template <class T>
py::object optionalMembers(const py::object& self, std::vector<T> TriangleMesh::*member) {
  const std::vector<T>& values = (self.cast<const Mesh&>().mesh).*member;
  if (values.empty()) return py::none();
  if constexpr (std::is_arithmetic_v<T>) {
    return members(self, values, values.data(), 1);
  } else {
    return members(self, values, values.front().data(), 3);
  }
}

py::object vertices(const py::object& self) {
  const std::vector<Eigen::Vector3f>& all = self.cast<const Mesh&>().mesh.vertices;
  return members(self, all, all.empty() ? nullptr : all.front().data(), 3);
}

py::object triangles(const py::object& self) {
  const std::vector<Triangle>& all = self.cast<const Mesh&>().mesh.triangles;
  return members(self, all, all.empty() ? nullptr : all.front().data(), 3);
}

// REQUIRES of both: N×3, of that type. Checked in Python.
using FloatTriples = py::array_t<float, py::array::c_style | py::array::forcecast>;
using WholeTriples = py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>;

MeshPointer fromArrays(const FloatTriples& vertices, const WholeTriples& triangles) {
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(vertices.shape(0)));
  mesh.triangles.resize(static_cast<std::size_t>(triangles.shape(0)));
  std::memcpy(static_cast<void*>(mesh.vertices.data()), vertices.data(),
              sizeof(Eigen::Vector3f) * mesh.vertices.size());
  std::memcpy(static_cast<void*>(mesh.triangles.data()), triangles.data(),
              sizeof(Triangle) * mesh.triangles.size());
  return makeMesh(std::move(mesh));
}

MeshPointer trimmed(const Mesh& mesh, float least) {
  Mesh copy = mesh;
  {
    const py::gil_scoped_release unlocked;
    trimUnsupported(least, copy.mesh);
  }
  return std::make_shared<Mesh>(std::move(copy));
}

MeshPointer simplified(const Mesh& mesh, std::size_t triangles, double tolerance) {
  Mesh copy = mesh;
  {
    const py::gil_scoped_release unlocked;
    simplify({triangles, tolerance}, copy.mesh);
    copy.mesh.normals = vertexNormals(copy.mesh);
  }
  return std::make_shared<Mesh>(std::move(copy));
}

py::dict topologyOf(const Mesh& mesh) {
  TopologyReport t;
  {
    const py::gil_scoped_release unlocked;
    t = topology(mesh.mesh);
  }
  return py::dict("vertices"_a = t.used_vertices, "triangles"_a = t.triangles, "edges"_a = t.edges,
                  "components"_a = t.components, "open_edges"_a = t.open_edges,
                  "nonmanifold_edges"_a = t.nonmanifold_edges,
                  "nonmanifold_vertices"_a = t.nonmanifold_vertices,
                  "inconsistent_edges"_a = t.inconsistent_edges, "euler_number"_a = t.euler_number,
                  "degenerate_triangles"_a = t.degenerate_triangles,
                  "zero_area_triangles"_a = t.zero_area_triangles, "closed"_a = isClosedManifold(t));
}

py::tuple boundsOf(const Mesh& mesh) {
  const Box box = boundingBox(mesh.mesh);
  const Eigen::Vector3d low = box.min(), high = box.max();
  return py::make_tuple(py::make_tuple(low.x(), low.y(), low.z()),
                        py::make_tuple(high.x(), high.y(), high.z()));
}

std::string shown(const Mesh& mesh) {
  const TriangleMesh& m = mesh.mesh;
  std::string text = "<vdbfuse.Mesh: " + std::to_string(m.vertices.size()) + " vertices, " +
                     std::to_string(m.triangles.size()) + " triangles";
  if (!m.normals.empty()) text += ", normals";
  if (!m.colors.empty()) text += ", colors";
  if (!m.support.empty()) text += ", support";
  return text + ">";
}

const std::vector<ScalarGrid>& gridsOf(const Mesh& mesh) {
  if (mesh.grids == nullptr) throw InvalidArgument("grids", "were not kept: call fuse(..., grids=True)");
  return *mesh.grids;
}

void saveGrids(const Mesh& mesh, const std::filesystem::path& path) {
  std::vector<const ScalarGrid*> grids;
  for (const ScalarGrid& grid : gridsOf(mesh)) grids.push_back(&grid);
  writeGrids(path, grids);
}

std::vector<std::string> gridNamesOf(const Mesh& mesh) {
  std::vector<std::string> names;
  if (mesh.grids != nullptr)
    for (const ScalarGrid& grid : *mesh.grids) names.push_back(grid.name());
  return names;
}

// World coordinates of the edges of a slice through the box: left, right, bottom, top.
py::tuple extentOf(const Box& box, int axis) {
  const int right = axis == 0 ? 1 : 0, up = axis == 2 ? 1 : 2;
  return py::make_tuple(box.min()[right], box.max()[right], box.min()[up], box.max()[up]);
}

py::tuple sliceOf(const Mesh& mesh, const std::string& grid, char axis_name, std::optional<double> value,
                  int longest) {
  const int axis = axis_name - 'x';
  Box box;
  Image<float> slice;
  {
    const py::gil_scoped_release unlocked;
    const GridLevels levels(gridsOf(mesh), grid);
    box = levels.box();
    if (axis < 0 || axis > 2) throw InvalidArgument("axis", "must be 'x', 'y' or 'z'");
    const auto field = [&](const Eigen::Vector3d& point) { return levels.at(point).value; };
    slice = sampleSlice(field, box, {axis, value.value_or(box.center()[axis])}, longest);
  }
  const py::array_t<float> values({slice.height(), slice.width()}, slice.data());
  return py::make_tuple(values, extentOf(box, axis));
}

void bindArrays(py::class_<Mesh, MeshPointer>& mesh) {
  mesh.def_property_readonly("vertices", vertices, "(V, 3) float32: world coordinates, unit of the poses.")
      .def_property_readonly("triangles", triangles,
                             "(T, 3) uint32: vertices of each, counter-clockwise seen from outside.")
      .def_property_readonly(
          "normals", [](const py::object& self) { return optionalMembers(self, &TriangleMesh::normals); },
          "(V, 3) float32: unit vectors that point outwards; or None.")
      .def_property_readonly(
          "colors", [](const py::object& self) { return optionalMembers(self, &TriangleMesh::colors); },
          "(V, 3) uint8: red, green, blue; or None.")
      .def_property_readonly(
          "support", [](const py::object& self) { return optionalMembers(self, &TriangleMesh::support); },
          "(V,) float32: number of views that agree with the surface there, 0 where it was invented (TSDF: "
          "sum of weights); or None.")
      .def_property_readonly(
          "confidence",
          [](const py::object& self) { return optionalMembers(self, &TriangleMesh::confidence); },
          "(V,) float32 in [0, 1]: 1 - exp(-mu support); or None.");
}

}  // namespace

void bindMesh(py::module_& module) {
  py::class_<Mesh, MeshPointer> mesh(
      module, "Mesh",
      "A triangle mesh. Its arrays are read-only views of its memory, not copies; they keep it alive.\n\n"
      "For Open3D: o3d.geometry.TriangleMesh(o3d.utility.Vector3dVector(mesh.vertices),\n"
      "o3d.utility.Vector3iVector(mesh.triangles.astype('int32'))); for trimesh:\n"
      "trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False).");
  bindArrays(mesh);
  mesh.def_property_readonly(
          "report", [](const Mesh& self) { return self.report; },
          "dict: what fuse() found out and did: calibration, grid, cut, energy, steps, memory, as in the "
          "JSON "
          "file of `vdbfuse fuse --json`. Empty for other meshes.")
      .def_property_readonly(
          "comments", [](const Mesh& self) { return self.mesh.comments; },
          "list of str: what save() writes as comments.")
      .def_property_readonly("bounds", boundsOf, "Lower and upper corner of the bounding box.")
      .def_property_readonly(
          "area", [](const Mesh& self) { return area(self.mesh); }, "Sum of the triangles' areas.")
      .def_property_readonly(
          "volume", [](const Mesh& self) { return signedVolume(self.mesh); },
          "Volume enclosed by a closed mesh; negative when it is inside out.")
      .def_property_readonly("grids", gridNamesOf,
                             "Names of the grids, where fuse(..., grids=True) kept any.")
      .def("topology", topologyOf,
           "dict: components, open_edges, nonmanifold_edges, euler_number, closed and other counts.")
      .def("trim", trimmed, "least"_a,
           "Mesh without the triangles that fewer views than `least` agree on (0.3: what was invented).")
      .def("simplify", simplified, "triangles"_a = 0, "tolerance"_a = 0.0,
           "Mesh of about so many triangles, or no further than `tolerance` (its unit) from this one. Closed "
           "meshes stay closed.")
      .def(
          "save", [](const Mesh& self, const std::filesystem::path& path) { writeMesh(path, self.mesh); },
          "path"_a, Unlocked(),
          "Writes .ply, .obj, .stl or .glb, the same bytes as the command line tool; replaces a file that is "
          "there.")
      .def("save_grids", saveGrids, "path"_a, Unlocked(), "Writes the grids as OpenVDB's .vdb.")
      .def(
          "slice", sliceOf, "grid"_a = "surface", "axis"_a = 'z', "value"_a = py::none(), "longest"_a = 512,
          "(values, extent) of a plane at right angles to an axis, through the middle unless `value` says "
          "where.\n\nvalues: (H, W) float32, NaN where nothing is known, the first row on top; extent: left, "
          "right, bottom, top in world coordinates, as matplotlib's imshow takes them. Axis z: x to the "
          "right, "
          "y upwards; y: x and z; x: y and z. Grids: surface, rho, sigma, support.")
      .def("__repr__", shown);
  module.def("mesh_from_arrays", fromArrays, "vertices"_a, "triangles"_a);
  module.def(
      "read_mesh",
      [](const std::filesystem::path& path) {
        TriangleMesh read = [&] {
          const py::gil_scoped_release unlocked;
          return readMesh(path);
        }();
        return makeMesh(std::move(read));
      },
      "path"_a);
}

}  // namespace vdbfuse::python
