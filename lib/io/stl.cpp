// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <numeric>
#include <tuple>

#include "mesh_formats.h"
#include "text_cursor.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse::io {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is written and read without swapping");

constexpr std::size_t kHeader = 80, kCounted = 84, kRecord = 50, kNormal = 12;

// By bits, so that the order is total even where a coordinate is not a number.
std::tuple<std::uint32_t, std::uint32_t, std::uint32_t> key(const Eigen::Vector3f& v) {
  const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x == 0.0f ? 0.0f : x); };
  return {bits(v.x()), bits(v.y()), bits(v.z())};
}

// Corner 3i + k of the soup belongs to triangle i. Vertices keep the order in which they come first.
TriangleMesh weld(const std::vector<Eigen::Vector3f>& soup) {
  std::vector<std::uint32_t> order(soup.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple_cat(key(soup[a]), std::tuple(a)) < std::tuple_cat(key(soup[b]), std::tuple(b));
  });
  std::vector<std::uint32_t> first(soup.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(soup[order[i]]) == key(soup[order[i - 1]]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  TriangleMesh mesh;
  std::vector<std::uint32_t>& number = order;
  for (std::uint32_t i = 0; i < soup.size(); ++i) {
    if (first[i] == i) {
      number[i] = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(soup[i]);
    }
    if (i % 3 == 2) mesh.triangles.push_back({number[first[i - 2]], number[first[i - 1]], number[first[i]]});
  }
  return mesh;
}

std::uint32_t recordCount(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeader, sizeof count);
  return count;
}

std::vector<Eigen::Vector3f> binarySoup(std::string_view bytes) {
  std::vector<Eigen::Vector3f> soup(3 * std::size_t{recordCount(bytes)});
  for (std::size_t i = 0; i < soup.size(); ++i) {
    const std::size_t at = kCounted + i / 3 * kRecord + kNormal + i % 3 * sizeof(Eigen::Vector3f);
    std::memcpy(soup[i].data(), bytes.data() + at, sizeof(Eigen::Vector3f));
  }
  return soup;
}

std::vector<Eigen::Vector3f> textSoup(const std::filesystem::path& path, std::string_view bytes) {
  std::vector<Eigen::Vector3f> soup;
  TextCursor cursor(path, bytes);
  std::size_t corners = 0;
  for (std::string_view word = cursor.word(); !word.empty(); word = cursor.word()) {
    if (word == "solid" || word == "endsolid") {
      cursor.restOfLine();
    } else if (word == "vertex") {
      Eigen::Vector3d v;
      for (double& coordinate : v) coordinate = cursor.number();
      soup.push_back(v.cast<float>());
      ++corners;
    } else if (word == "endfacet") {
      if (corners != 3) cursor.failWith("three vertices before the end of a facet", std::to_string(corners));
      corners = 0;
    }
  }
  if (corners != 0) cursor.fail("endfacet", "");
  return soup;
}

void append(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

}  // namespace

// Some binary files begin with "solid", so that the size decides first.
TriangleMesh parseStl(const std::filesystem::path& path, std::string_view bytes) {
  const bool has_count = bytes.size() >= kCounted;
  const std::size_t promised = has_count ? kCounted + kRecord * std::size_t{recordCount(bytes)} : kCounted;
  const bool binary = has_count && bytes.size() == promised;
  if (!binary && !bytes.starts_with("solid")) {
    throw IoError(path, "byte " + std::to_string(bytes.size()),
                  "'solid' at the start, or a binary file of " + std::to_string(promised) + " bytes",
                  "the end");
  }
  const std::vector<Eigen::Vector3f> soup = binary ? binarySoup(bytes) : textSoup(path, bytes);
  if (soup.size() > std::numeric_limits<std::uint32_t>::max()) throw IoError(path, "has too many triangles");
  return weld(soup);
}

std::string formatStl(const TriangleMesh& mesh) {
  std::string bytes("binary STL, written by vdbfuse");
  for (const std::string& comment : mesh.comments) bytes += "; " + comment;
  bytes.resize(kHeader, ' ');
  bytes.reserve(kCounted + kRecord * mesh.triangles.size());
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  append(bytes, &count, sizeof count);
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3f &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    Eigen::Vector3f normal = (b - a).cross(c - a);
    normal.stableNormalize();
    for (const Eigen::Vector3f& v : {normal, a, b, c}) append(bytes, v.data(), sizeof v);
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace vdbfuse::io
