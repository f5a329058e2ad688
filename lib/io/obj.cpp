// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <limits>

#include "mesh_formats.h"
#include "text_cursor.h"

namespace vdbfuse::io {
namespace {

// The vertex of one corner, "7", "7/1", "7//3" or "-1" (the last vertex so far), counted from 0.
std::uint32_t parseCorner(const TextCursor& cursor, std::string_view word, std::size_t vertices) {
  const auto given = parseInteger(word.substr(0, word.find('/')));
  const auto count = static_cast<std::int64_t>(vertices);
  // A face may come before its vertices, so that only the limit of the type is known here.
  const bool fits =
      given && *given != 0 && *given >= -count && *given <= std::numeric_limits<std::uint32_t>::max();
  if (!fits) cursor.fail("the number of a vertex", word);
  return static_cast<std::uint32_t>(*given > 0 ? *given - 1 : count + *given);
}

void parseFace(TextCursor& cursor, TriangleMesh& mesh) {
  Triangle fan{};
  std::size_t corners = 0;
  for (std::string_view word = cursor.wordOnLine(); !word.empty(); word = cursor.wordOnLine()) {
    const std::uint32_t vertex = parseCorner(cursor, word, mesh.vertices.size());
    if (corners < 2) {
      fan[corners] = vertex;
    } else {
      if (corners > 2) fan[1] = fan[2];
      fan[2] = vertex;
      mesh.triangles.push_back(fan);
    }
    ++corners;
  }
  if (corners < 3) cursor.fail("three or more vertices of a face", "");
}

void append(std::string& text, float value) {
  char digits[32];
  text.append(" ").append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void append(std::string& text, const char* keyword, const Eigen::Vector3f& v) {
  text += keyword;
  for (int k = 0; k < 3; ++k) append(text, v[k]);
  text += '\n';
}

}  // namespace

TriangleMesh parseObj(const std::filesystem::path& path, std::string_view bytes) {
  TriangleMesh mesh;
  TextCursor cursor(path, bytes);
  while (!cursor.atEnd()) {
    const std::string_view keyword = cursor.wordOnLine();
    if (keyword == "v") {
      Eigen::Vector3d v;
      for (double& coordinate : v) coordinate = cursor.numberOnLine();
      mesh.vertices.push_back(v.cast<float>());
    } else if (keyword == "f") {
      parseFace(cursor, mesh);
    }
    cursor.restOfLine();
  }
  return mesh;
}

std::string formatObj(const TriangleMesh& mesh) {
  std::string text;
  for (const std::string& comment : mesh.comments) text += "# " + comment + '\n';
  for (const Eigen::Vector3f& v : mesh.vertices) append(text, "v", v);
  for (const Eigen::Vector3f& n : mesh.normals) append(text, "vn", n);
  for (const Triangle& t : mesh.triangles) {
    text += 'f';
    for (const std::uint32_t v : t) {
      const std::string number = std::to_string(std::uint64_t{v} + 1);
      text += ' ' + number;
      if (!mesh.normals.empty()) text += "//" + number;
    }
    text += '\n';
  }
  return text;
}

}  // namespace vdbfuse::io
