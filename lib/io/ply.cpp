// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "mesh_formats.h"
#include "ply_header.h"
#include "ply_values.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written as it lies in memory");

// What a vertex may carry that we keep, in the order of the numbers below.
constexpr std::array<std::string_view, 11> kVertexNames = {
    "x", "y", "z", "nx", "ny", "nz", "red", "green", "blue", "quality", "confidence"};
constexpr std::size_t kNormal = 3, kColor = 6, kSupport = 9, kConfidence = 10;

// For each property its place in kVertexNames, or the size of that list.
struct VertexLayout {
  std::vector<std::size_t> slots;
  std::array<bool, kVertexNames.size() + 1> has{};
};

VertexLayout layoutOf(const std::filesystem::path& path, const PlyElement& element) {
  VertexLayout layout;
  for (const PlyProperty& p : element.properties) {
    auto slot = static_cast<std::size_t>(std::find(kVertexNames.begin(), kVertexNames.end(), p.name) -
                                         kVertexNames.begin());
    const bool is_color = slot >= kColor && slot < kSupport;
    if (p.count_type || (is_color && p.type != PlyType::Uint8)) slot = kVertexNames.size();
    layout.slots.push_back(slot);
    layout.has[slot] = true;
  }
  for (std::size_t k = 0; k < kNormal; ++k) {
    if (!layout.has[k])
      throw IoError(path, "", "vertices with x, y and z", "none of the name " + std::string(kVertexNames[k]));
  }
  return layout;
}

template <class Values>
void readVertices(const std::filesystem::path& path, Values& values, const PlyElement& element,
                  TriangleMesh& mesh) {
  const VertexLayout layout = layoutOf(path, element);
  const auto& has = layout.has;
  const auto count = static_cast<std::size_t>(element.count);
  mesh.vertices.resize(count);
  const auto all = [&](std::size_t k) { return has[k] && has[k + 1] && has[k + 2]; };
  mesh.normals.resize(all(kNormal) ? count : 0);
  mesh.colors.resize(all(kColor) ? count : 0);
  mesh.support.resize(has[kSupport] ? count : 0);
  mesh.confidence.resize(has[kConfidence] ? count : 0);
  std::array<double, kVertexNames.size()> v{};
  const auto vector = [&](std::size_t k) {
    return Eigen::Vector3f(static_cast<float>(v[k]), static_cast<float>(v[k + 1]),
                           static_cast<float>(v[k + 2]));
  };
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t p = 0; p < layout.slots.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (layout.slots[p] < v.size())
        v[layout.slots[p]] = values.next(property.type);
      else
        skip(values, property);
    }
    mesh.vertices[i] = vector(0);
    if (!mesh.normals.empty()) mesh.normals[i] = vector(kNormal);
    for (std::size_t k = 0; k < 3 && !mesh.colors.empty(); ++k) {
      mesh.colors[i][k] = static_cast<std::uint8_t>(std::clamp(v[kColor + k], 0.0, 255.0));
    }
    if (!mesh.support.empty()) mesh.support[i] = static_cast<float>(v[kSupport]);
    if (!mesh.confidence.empty()) mesh.confidence[i] = static_cast<float>(v[kConfidence]);
  }
}

template <class Values>
void readFan(Values& values, const PlyProperty& property, TriangleMesh& mesh) {
  const std::size_t length = listLength(values, property);
  if (length < 3) values.fail("a face of three or more vertices", std::to_string(length));
  Triangle fan{};
  for (std::size_t i = 0; i < length; ++i) {
    const double index = values.next(property.type);
    if (!(index >= 0 && index <= std::numeric_limits<std::uint32_t>::max())) {
      values.fail("the index of a vertex", shown(index));
    }
    if (i > 2) fan[1] = fan[2];
    fan[std::min<std::size_t>(i, 2)] = static_cast<std::uint32_t>(index);
    if (i >= 2) mesh.triangles.push_back(fan);
  }
}

template <class Values>
void readFaces(Values& values, const PlyElement& element, TriangleMesh& mesh) {
  if (element.properties.empty()) return;
  const auto is_fan = [](const PlyProperty& p) {
    return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
  };
  mesh.triangles.reserve(static_cast<std::size_t>(element.count));
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& p : element.properties) {
      if (is_fan(p))
        readFan(values, p, mesh);
      else
        skip(values, p);
    }
  }
}

template <class Values>
TriangleMesh readElements(const std::filesystem::path& path, std::string_view bytes,
                          const PlyHeader& header) {
  TriangleMesh mesh;
  Values values(path, bytes, header);
  for (const PlyElement& element : header.elements) {
    checkRoom(values, element);
    if (element.name == "vertex")
      readVertices(path, values, element, mesh);
    else if (element.name == "face")
      readFaces(values, element, mesh);
    else
      skipElement(values, element);
  }
  return mesh;
}

std::string headerOf(const TriangleMesh& mesh) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : mesh.comments) text += "comment " + comment + "\n";
  text += "element vertex " + std::to_string(mesh.vertices.size()) +
          "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) text += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.colors.empty()) text += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  if (!mesh.support.empty()) text += "property float quality\n";
  if (!mesh.confidence.empty()) text += "property float confidence\n";
  return text + "element face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

TriangleMesh parsePly(const std::filesystem::path& path, std::string_view bytes) {
  const PlyHeader header = parsePlyHeader(path, bytes);
  if (header.encoding == PlyEncoding::Ascii) return readElements<TextValues>(path, bytes, header);
  return readElements<BinaryValues>(path, bytes, header);
}

std::string formatPly(const TriangleMesh& mesh) {
  std::string bytes = headerOf(mesh);
  bytes.reserve(bytes.size() + 35 * mesh.vertices.size() + 13 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    append(bytes, mesh.vertices[i]);
    if (!mesh.normals.empty()) append(bytes, mesh.normals[i]);
    if (!mesh.colors.empty()) append(bytes, mesh.colors[i]);
    if (!mesh.support.empty()) append(bytes, mesh.support[i]);
    if (!mesh.confidence.empty()) append(bytes, mesh.confidence[i]);
  }
  for (const Triangle& t : mesh.triangles) {
    bytes += '\3';
    append(bytes, t);
  }
  return bytes;
}

}  // namespace vdbfuse::io
