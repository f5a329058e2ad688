// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/trim.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <numeric>

#include "surface/split_rim.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
void trimUnsupported(float least, TriangleMesh& mesh) {
  if (mesh.support.size() != mesh.vertices.size()) throw InvalidArgument("mesh", "has no support to trim by");
  std::vector<bool> is_rim(mesh.vertices.size());
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const bool is_cut =
        std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return mesh.support[v] < least; });
    if (is_cut) is_rim[t[0]] = is_rim[t[1]] = is_rim[t[2]] = true;
    return is_cut;
  });
  std::vector<std::uint32_t> rim;
  for (std::uint32_t v = 0; v < is_rim.size(); ++v) {
    if (is_rim[v]) rim.push_back(v);
  }
  splitFans(mesh, rim);
  dropUnusedVertices(mesh);
  char comment[96];
  std::snprintf(comment, sizeof comment, "open: trimmed where fewer than %g views agree",
                static_cast<double>(least));
  mesh.comments.emplace_back(comment);
}

std::size_t dropSmallComponents(double diagonal, TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    parent[std::max(a, b)] = std::min(a, b);
  };
  for (const Triangle& t : mesh.triangles) join(t[0], t[1]), join(t[0], t[2]);
  std::map<std::uint32_t, Box> boxes;
  for (const Triangle& t : mesh.triangles) {
    Box& box = boxes[root(t[0])];
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v].cast<double>());
  }
  const auto is_small = [&](std::uint32_t component) {
    return boxes[component].diagonal().norm() < diagonal;
  };
  std::size_t dropped = 0;
  for (const auto& component : boxes) dropped += is_small(component.first) ? 1 : 0;
  if (dropped == 0) return 0;
  std::erase_if(mesh.triangles, [&](const Triangle& t) { return is_small(root(t[0])); });
  dropUnusedVertices(mesh);
  return dropped;
}

}  // namespace vdbfuse
