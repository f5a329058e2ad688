// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <string>

#include "file_bytes.h"
#include "mesh_formats.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/glb.h"

namespace vdbfuse {
namespace {

struct Format {
  const char* extension;
  TriangleMesh (*parse)(const std::filesystem::path&, std::string_view);
  std::string (*format)(const TriangleMesh&);
};

std::string formatGlb(const TriangleMesh& mesh) { return glbBytes(mesh); }

constexpr Format kFormats[] = {{".ply", io::parsePly, io::formatPly},
                               {".obj", io::parseObj, io::formatObj},
                               {".stl", io::parseStl, io::formatStl},
                               {".glb", nullptr, formatGlb}};

const Format& formatOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format;
  }
  throw IoError(path, "", "the extension .ply, .obj, .stl or .glb", extension.empty() ? "none" : extension);
}

std::size_t largestIndex(const Triangle& t) { return *std::max_element(t.begin(), t.end()); }

void checkBeforeWriting(const TriangleMesh& mesh) {
  const auto fits = [&](std::size_t size) { return size == 0 || size == mesh.vertices.size(); };
  if (!fits(mesh.normals.size()) || !fits(mesh.colors.size()) || !fits(mesh.support.size()) ||
      !fits(mesh.confidence.size())) {
    throw InvalidArgument("mesh",
                          "normals, colors, support and confidence need one value a vertex or none at all");
  }
  for (const Triangle& t : mesh.triangles) {
    if (largestIndex(t) >= mesh.vertices.size()) {
      throw InvalidArgument("mesh", "a triangle names vertex " + std::to_string(largestIndex(t)) + " of " +
                                        std::to_string(mesh.vertices.size()));
    }
  }
}

void checkAfterReading(const std::filesystem::path& path, const TriangleMesh& mesh) {
  for (const Triangle& t : mesh.triangles) {
    if (largestIndex(t) < mesh.vertices.size()) continue;
    throw IoError(path, "", "faces of the " + std::to_string(mesh.vertices.size()) + " vertices in the file",
                  "one with vertex " + std::to_string(largestIndex(t)));
  }
}

}  // namespace

void requireMeshFormat(const std::filesystem::path& path) { formatOf(path); }

void writeMesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  const Format& format = formatOf(path);
  checkBeforeWriting(mesh);
  io::writeFileBytes(path, format.format(mesh));
}

TriangleMesh readMesh(const std::filesystem::path& path) {
  const Format& format = formatOf(path);
  if (format.parse == nullptr)
    throw IoError(path, "", "a mesh to read: .ply, .obj or .stl", format.extension);
  TriangleMesh mesh = format.parse(path, io::readFileBytes(path));
  checkAfterReading(path, mesh);
  return mesh;
}

}  // namespace vdbfuse
