// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/rim.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "surface/block_set.h"
#include "surface/split_rim.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using Patch = PaddedBlock<1, 1>;

struct Gap {
  Index3 voxel;
  float value;
};

// Whether one of the eight cubes around a voxel has known corners of both signs.
bool isBesideSurface(const Patch& patch, int x, int y, int z) {
  for (int cube = 0; cube < 8; ++cube) {
    const int cx = x - (cube >> 2), cy = y - (cube >> 1 & 1), cz = z - (cube & 1);
    bool has_inside = false, has_outside = false;
    for (int corner = 0; corner < 8; ++corner) {
      const float value = patch.at(cx + (corner >> 2), cy + (corner >> 1 & 1), cz + (corner & 1));
      has_inside |= value < 0, has_outside |= value >= 0;
    }
    if (has_inside && has_outside) return true;
  }
  return false;
}

// What the differences along the axes lead to.
std::optional<float> extrapolated(const ScalarGrid& field, const Index3& voxel) {
  float sum = 0;
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const Index3 step = side * Index3::Unit(axis);
      const float near = field.at(voxel + step);
      if (std::isnan(near)) continue;
      const float far = field.at(voxel + 2 * step);
      // Without a second one it is as far as the first.
      sum += std::isnan(far) ? near : 2 * near - far;
      ++count;
    }
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<float>(count);
}

void findGaps(const ScalarGrid& field, const BlockSet& blocks, const float* values, std::size_t block,
              std::vector<Gap>& gaps) {
  Patch patch;
  loadPadded(blocks, values, block, kUnknown, patch);
  const auto [least, most] =
      std::minmax_element(patch.values.begin(), patch.values.end(), [](float a, float b) {
        // Unknown ones in the middle, where they are no extreme.
        return (std::isnan(a) ? 0.0f : a) < (std::isnan(b) ? 0.0f : b);
      });
  if (!(*least < 0) || !(*most > 0)) return;
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      for (int z = 0; z < 8; ++z) {
        if (!std::isnan(patch.at(x, y, z)) || !isBesideSurface(patch, x, y, z)) continue;
        const Index3 voxel = blocks.origin(block) + Index3(x, y, z);
        if (const auto value = extrapolated(field, voxel)) gaps.push_back({voxel, *value});
      }
    }
  }
}

// All leaves of a field and those around them, with its values.
struct Surroundings {
  BlockSet blocks;
  std::vector<float> values;

  explicit Surroundings(const ScalarGrid& field)
      : blocks(originsAround(field)), values(blocks.valueCount(), kUnknown) {
    field.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
      std::copy(leaf.values.begin(), leaf.values.end(), &values[blocks.find(leaf.origin) * kBlockSize]);
    });
  }

 private:
  static std::vector<Index3> originsAround(const ScalarGrid& field) {
    std::vector<Index3> origins;
    for (std::size_t i = 0; i < field.leafCount(); ++i) {
      const Index3 origin = field.leaf(i).origin;
      for (int n = 0; n < 27; ++n)
        origins.emplace_back(origin + 8 * Index3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1));
    }
    return origins;
  }
};

// Steps over edges from the vertices that are marked, up to `most`.
std::vector<int> ringsFrom(const TriangleMesh& mesh, const std::vector<bool>& marked, int most) {
  std::vector<int> rings(mesh.vertices.size(), most + 1);
  for (std::size_t v = 0; v < rings.size(); ++v) {
    if (marked[v]) rings[v] = 0;
  }
  for (int ring = 1; ring <= most; ++ring) {
    for (const Triangle& t : mesh.triangles) {
      if (std::min({rings[t[0]], rings[t[1]], rings[t[2]]}) != ring - 1) continue;
      for (const std::uint32_t v : t) rings[v] = std::min(rings[v], ring);
    }
  }
  return rings;
}

std::vector<bool> rimVertices(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  std::vector<bool> is_rim(mesh.vertices.size());
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end == i + 1) is_rim[edges[i].first] = is_rim[edges[i].second] = true;
    i = end;
  }
  return is_rim;
}

}  // namespace

ScalarGrid closeGaps(const ScalarGrid& field) {
  const Surroundings around(field);
  std::vector<std::vector<Gap>> parts(around.blocks.count());
  forEachBlock(around.blocks.count(),
               [&](std::size_t b) { findGaps(field, around.blocks, around.values.data(), b, parts[b]); });
  std::vector<Index3> origins;
  for (std::size_t i = 0; i < field.leafCount(); ++i) origins.push_back(field.leaf(i).origin);
  for (std::size_t b = 0; b < parts.size(); ++b) {
    if (!parts[b].empty()) origins.push_back(around.blocks.origin(b));
  }
  ScalarGrid result(field.name(), field.frame(), field.background(), origins);
  result.setKind(GridKind::LevelSet);
  result.metadata() = field.metadata();
  result.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    const std::size_t b = around.blocks.find(leaf.origin);
    std::copy_n(&around.values[b * kBlockSize], kBlockSize, leaf.values.begin());
    for (const Gap& gap : parts[b]) leaf.values[leafPlace(gap.voxel)] = gap.value;
  });
  return result;
}

std::size_t trimRim(int rings, TriangleMesh& mesh) {
  if (rings < 1) throw InvalidArgument("rings", "must be positive");
  const std::vector<int> from_rim = ringsFrom(mesh, rimVertices(mesh), rings);
  std::vector<bool> is_inner(mesh.vertices.size());
  std::transform(from_rim.begin(), from_rim.end(), is_inner.begin(), [&](int ring) { return ring > rings; });
  const std::vector<int> from_inner = ringsFrom(mesh, is_inner, rings);
  std::vector<bool> touched(mesh.vertices.size());
  const std::size_t removed = std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const bool is_ragged = std::min({from_inner[t[0]], from_inner[t[1]], from_inner[t[2]]}) >= rings;
    if (is_ragged) touched[t[0]] = touched[t[1]] = touched[t[2]] = true;
    return is_ragged;
  });
  if (removed == 0) return 0;
  std::vector<std::uint32_t> changed;
  for (std::uint32_t v = 0; v < touched.size(); ++v) {
    if (touched[v]) changed.push_back(v);
  }
  splitFans(mesh, changed);
  dropUnusedVertices(mesh);
  return removed;
}

}  // namespace vdbfuse
