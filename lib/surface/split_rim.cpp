// SPDX-License-Identifier: Apache-2.0
#include "surface/split_rim.h"

#include <algorithm>

namespace vdbfuse {
namespace {

// One triangle's corner at a vertex, and the two vertices beside it.
struct FanCorner {
  std::uint32_t vertex, triangle;
  std::size_t corner;
  std::uint32_t next, previous;
};

std::vector<FanCorner> cornersAt(const TriangleMesh& mesh, const std::vector<std::uint32_t>& vertices) {
  std::vector<bool> wanted(mesh.vertices.size(), false);
  for (const std::uint32_t v : vertices) wanted[v] = true;
  std::vector<FanCorner> corners;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      if (wanted[t[k]])
        corners.push_back({t[k], static_cast<std::uint32_t>(i), k, t[(k + 1) % 3], t[(k + 2) % 3]});
    }
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const FanCorner& a, const FanCorner& b) { return a.vertex < b.vertex; });
  return corners;
}

// Moves the corners that share an edge with one of [first, middle) there, until none is left; returns the end
// of the fan.
template <class Iterator>
Iterator gatherFan(Iterator first, Iterator end) {
  Iterator middle = first + 1;
  for (Iterator seed = first; seed != middle; ++seed) {
    const FanCorner here = *seed;
    middle = std::partition(middle, end, [&](const FanCorner& other) {
      return other.next == here.previous || other.previous == here.next;
    });
  }
  return middle;
}

}  // namespace

void splitFans(TriangleMesh& mesh, const std::vector<std::uint32_t>& vertices) {
  std::vector<FanCorner> corners = cornersAt(mesh, vertices);
  for (auto first = corners.begin(); first != corners.end();) {
    const std::uint32_t vertex = first->vertex;
    const auto end =
        std::find_if(first, corners.end(), [&](const FanCorner& c) { return c.vertex != vertex; });
    for (auto fan = gatherFan(first, end); fan != end;) {
      const auto next = gatherFan(fan, end);
      const std::uint32_t copy = appendCopy(mesh, vertex);
      for (; fan != next; ++fan) mesh.triangles[fan->triangle][fan->corner] = copy;
    }
    first = end;
  }
}

}  // namespace vdbfuse
