// SPDX-License-Identifier: Apache-2.0
// The mesh formats behind readMesh() and writeMesh(): from bytes and to bytes. `path` is only for messages.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vdbfuse/mesh/triangle_mesh.h"

namespace vdbfuse::io {

TriangleMesh parsePly(const std::filesystem::path& path, std::string_view bytes);
std::string formatPly(const TriangleMesh& mesh);

TriangleMesh parseObj(const std::filesystem::path& path, std::string_view bytes);
std::string formatObj(const TriangleMesh& mesh);

TriangleMesh parseStl(const std::filesystem::path& path, std::string_view bytes);
std::string formatStl(const TriangleMesh& mesh);

}  // namespace vdbfuse::io
