// SPDX-License-Identifier: Apache-2.0
// Binary glTF 2.0: a header, one chunk of JSON and one of bytes (the specification's section 4.4).
#include "vdbfuse/io/glb.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of the specification.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::uint32_t kMagic = 0x46546c67, kVersion = 2, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;

void append(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}
void append(std::string& bytes, std::uint32_t value) { append(bytes, &value, sizeof value); }

// Up in glTF is +y: a quarter turn about x.
Eigen::Vector3f turned(const Eigen::Vector3f& v) { return {v.x(), v.z(), -v.y()}; }

float linear(std::uint8_t srgb) {
  const float value = static_cast<float>(srgb) / 255;
  return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

// The bytes of the file, and what its JSON says of them.
struct Contents {
  std::string bytes;
  Json views = Json::array(), accessors = Json::array();

  /// Returns the number of the accessor.
  std::size_t add(const std::string& values, std::size_t count, int target, int component, const char* type) {
    views.push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size()}, {"target", target}});
    accessors.push_back(
        {{"bufferView", views.size() - 1}, {"componentType", component}, {"count", count}, {"type", type}});
    bytes += values;
    return accessors.size() - 1;
  }
  template <class Values, class Convert>
  std::size_t addFloats(const Values& values, const char* type, const Convert& convert) {
    std::string raw;
    for (const auto& value : values) {
      const auto converted = convert(value);
      append(raw, &converted, sizeof converted);
    }
    return add(raw, values.size(), kArrayBuffer, kFloat, type);
  }
};

std::size_t addPositions(const TriangleMesh& mesh, Contents& contents) {
  const std::size_t accessor = contents.addFloats(mesh.vertices, "VEC3", turned);
  Eigen::Vector3f low = Eigen::Vector3f::Zero(), high = low;
  if (!mesh.vertices.empty()) low = high = turned(mesh.vertices.front());
  for (const Eigen::Vector3f& v : mesh.vertices)
    low = low.cwiseMin(turned(v)), high = high.cwiseMax(turned(v));
  contents.accessors[accessor]["min"] = {low.x(), low.y(), low.z()};
  contents.accessors[accessor]["max"] = {high.x(), high.y(), high.z()};
  return accessor;
}

void requireOneAVertex(const TriangleMesh& mesh, const VertexValues& values) {
  if (values.values.size() == mesh.vertices.size()) return;
  throw InvalidArgument(values.name, std::to_string(values.values.size()) + " values for " +
                                         std::to_string(mesh.vertices.size()) + " vertices");
}

Json addAttributes(const TriangleMesh& mesh, const std::vector<VertexValues>& more, Contents& contents) {
  const auto same = [](float value) { return value; };
  Json attributes = {{"POSITION", addPositions(mesh, contents)}};
  if (!mesh.normals.empty()) attributes["NORMAL"] = contents.addFloats(mesh.normals, "VEC3", turned);
  if (!mesh.colors.empty()) {
    attributes["COLOR_0"] = contents.addFloats(mesh.colors, "VEC3", [](const Rgb8& color) {
      return Eigen::Vector3f(linear(color[0]), linear(color[1]), linear(color[2]));
    });
  }
  if (!mesh.support.empty()) attributes["_SUPPORT"] = contents.addFloats(mesh.support, "SCALAR", same);
  if (!mesh.confidence.empty())
    attributes["_CONFIDENCE"] = contents.addFloats(mesh.confidence, "SCALAR", same);
  for (const VertexValues& values : more) {
    requireOneAVertex(mesh, values);
    attributes[values.name] = contents.addFloats(values.values, "SCALAR", same);
  }
  return attributes;
}

void pad(std::string& chunk, char with) { chunk.resize((chunk.size() + 3) / 4 * 4, with); }

}  // namespace

std::string glbBytes(const TriangleMesh& mesh, const std::vector<VertexValues>& more) {
  Contents contents;
  Json primitive = {{"attributes", addAttributes(mesh, more, contents)}, {"material", 0}};
  std::string indices;
  for (const Triangle& t : mesh.triangles) append(indices, t.data(), sizeof t);
  primitive["indices"] =
      contents.add(indices, 3 * mesh.triangles.size(), kElementArrayBuffer, kUnsignedInt, "SCALAR");
  Json asset = {{"version", "2.0"}, {"generator", "vdbfuse"}};
  if (!mesh.comments.empty()) asset["extras"] = {{"comments", mesh.comments}};
  const Json document = {
      {"asset", asset},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"meshes", {{{"primitives", {primitive}}}}},
      {"materials", {{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.9}}}}}},
      {"buffers", {{{"byteLength", contents.bytes.size()}}}},
      {"bufferViews", contents.views},
      {"accessors", contents.accessors}};
  std::string json = document.dump();
  pad(json, ' '), pad(contents.bytes, '\0');
  std::string file;
  append(file, kMagic), append(file, kVersion);
  append(file, static_cast<std::uint32_t>(28 + json.size() + contents.bytes.size()));
  append(file, static_cast<std::uint32_t>(json.size())), append(file, kJsonChunk);
  file += json;
  append(file, static_cast<std::uint32_t>(contents.bytes.size())), append(file, kBinaryChunk);
  return file + contents.bytes;
}

}  // namespace vdbfuse
