// SPDX-License-Identifier: Apache-2.0
#include "surface/cube_cases.h"

#include <algorithm>
#include <bitset>

namespace vdbfuse {
namespace {

constexpr int kNone = -1;

// The four corners of each face, counter-clockwise seen from outside the cube.
constexpr std::array<std::array<int, 4>, 6> kFaces = {{
    {0, 4, 6, 2},  // x = 0
    {1, 3, 7, 5},  // x = 1
    {0, 1, 5, 4},  // y = 0
    {2, 6, 7, 3},  // y = 1
    {0, 2, 3, 1},  // z = 0
    {4, 5, 7, 6},  // z = 1
}};

int edgeBetween(int a, int b) {
  const int base = std::min(a, b), difference = a ^ b;
  const auto& edges = cubeEdges();
  const auto found = std::find_if(edges.begin(), edges.end(), [&](const CubeEdge& e) {
    return e.base == base && (1 << e.axis) == difference;
  });
  return static_cast<int>(found - edges.begin());
}

// next[e]: the edge that follows e on its polygon. On a face walked counter-clockwise each segment runs from
// a crossing that leaves the inside to the next crossing that enters it: around the outside corners, so that
// the inside is joined.
std::array<int, 12> successors(std::uint8_t inside) {
  std::array<int, 12> next;
  next.fill(kNone);
  const auto isInside = [&](int corner) { return (inside >> corner & 1) != 0; };
  for (const auto& face : kFaces) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (!isInside(face[k]) || isInside(face[(k + 1) % 4])) continue;
      std::size_t end = k + 1;
      while (!isInside(face[(end + 1) % 4])) ++end;
      const int entering = edgeBetween(face[end % 4], face[(end + 1) % 4]);
      next[static_cast<std::size_t>(entering)] = edgeBetween(face[k], face[(k + 1) % 4]);
    }
  }
  return next;
}

// Which faces an edge lies in, as bits.
unsigned facesOf(std::uint8_t edge) {
  const CubeEdge& e = cubeEdges()[edge];
  unsigned faces = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != e.axis) faces |= 1u << (2 * axis + (e.base >> axis & 1));
  }
  return faces;
}

using Triangles = std::vector<std::array<std::uint8_t, 3>>;

// Triangulates polygon[first … last] with the side (first, last) given; false when every way has a diagonal
// in a face.
bool triangulate(const std::vector<std::uint8_t>& polygon, std::size_t first, std::size_t last,
                 Triangles& out) {
  if (last - first < 2) return true;
  const auto allowed = [&](std::size_t a, std::size_t b) {
    const bool side = b - a == 1 || (a == 0 && b + 1 == polygon.size());
    return side || (facesOf(polygon[a]) & facesOf(polygon[b])) == 0;
  };
  for (std::size_t apex = first + 1; apex < last; ++apex) {
    if (!allowed(first, apex) || !allowed(apex, last)) continue;
    const std::size_t before = out.size();
    out.push_back({polygon[first], polygon[apex], polygon[last]});
    if (triangulate(polygon, first, apex, out) && triangulate(polygon, apex, last, out)) return true;
    out.resize(before);
  }
  return false;
}

void triangulate(CubePolygon& polygon) {
  if (triangulate(polygon.edges, 0, polygon.edges.size() - 1, polygon.triangles)) return;
  polygon.has_centre = true;
  for (std::size_t k = 0; k < polygon.edges.size(); ++k) {
    polygon.triangles.push_back({polygon.edges[k], polygon.edges[(k + 1) % polygon.edges.size()], kCentre});
  }
}

std::vector<CubePolygon> polygonsOf(std::uint8_t inside) {
  const std::array<int, 12> next = successors(inside);
  std::vector<CubePolygon> polygons;
  std::bitset<12> done;
  for (std::size_t first = 0; first < 12; ++first) {
    if (next[first] == kNone || done[first]) continue;
    CubePolygon polygon;
    for (std::size_t e = first; !done[e]; e = static_cast<std::size_t>(next[e])) {
      done.set(e);
      polygon.edges.push_back(static_cast<std::uint8_t>(e));
    }
    triangulate(polygon);
    polygons.push_back(std::move(polygon));
  }
  return polygons;
}

}  // namespace

const std::array<CubeEdge, 12>& cubeEdges() {
  static const std::array<CubeEdge, 12> kEdges = [] {
    std::array<CubeEdge, 12> edges;
    std::size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 8; ++corner) {
        if ((corner >> axis & 1) == 0) edges[count++] = {corner, axis};
      }
    }
    return edges;
  }();
  return kEdges;
}

const std::vector<CubePolygon>& cubePolygons(std::uint8_t inside) {
  static const std::vector<std::vector<CubePolygon>> kCases = [] {
    std::vector<std::vector<CubePolygon>> cases;
    for (int k = 0; k < 256; ++k) cases.push_back(polygonsOf(static_cast<std::uint8_t>(k)));
    return cases;
  }();
  return kCases[inside];
}

}  // namespace vdbfuse
