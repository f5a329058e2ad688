// SPDX-License-Identifier: Apache-2.0
#include "octree/local_maximum.h"

#include <algorithm>
#include <array>

#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr int kSide = ScalarGrid::kLeafSide;

// Values of a leaf along one axis with those of the leaves before and behind it.
using Line = std::array<float, 3 * kSide>;

// Steps between neighbours along x, y, z in a leaf.
constexpr std::array<std::size_t, 3> kStride = {64, 8, 1};

void maximumAlong(const ScalarGrid& in, int axis, int radius, const ScalarGrid::Leaf& out) {
  constexpr float kNothing = -std::numeric_limits<float>::infinity();
  std::array<const float*, 3> sources{};
  for (int k = 0; k < 3; ++k) {
    const auto found = in.findLeaf(out.origin + (k - 1) * kSide * Index3::Unit(axis));
    if (found) sources[static_cast<std::size_t>(k)] = in.leaf(*found).values.data();
  }
  const std::size_t stride = kStride[static_cast<std::size_t>(axis)];
  const std::size_t u = kStride[static_cast<std::size_t>((axis + 1) % 3)],
                    v = kStride[static_cast<std::size_t>((axis + 2) % 3)];
  for (std::size_t i = 0; i < kSide; ++i) {
    for (std::size_t j = 0; j < kSide; ++j) {
      const std::size_t first = i * u + j * v;
      Line line;
      for (std::size_t k = 0; k < line.size(); ++k) {
        const float* source = sources[k / kSide];
        line[k] = source != nullptr ? source[first + k % kSide * stride] : kNothing;
      }
      for (int k = 0; k < kSide; ++k) {
        const auto here = line.begin() + kSide + k;
        out.values[first + static_cast<std::size_t>(k) * stride] =
            *std::max_element(here - radius, here + radius + 1);
      }
    }
  }
}

}  // namespace

ScalarGrid localMaximum(const ScalarGrid& grid, int radius) {
  std::vector<Index3> origins;
  for (std::size_t i = 0; i < grid.leafCount(); ++i) origins.push_back(grid.leaf(i).origin);
  const ScalarGrid* in = &grid;
  std::vector<ScalarGrid> passes;
  passes.reserve(3);
  for (int axis = 0; axis < 3; ++axis) {
    passes.emplace_back("maximum", grid.frame(), grid.background(), origins);
    passes.back().forEachLeaf([&](const ScalarGrid::Leaf& leaf) { maximumAlong(*in, axis, radius, leaf); });
    in = &passes.back();
  }
  return std::move(passes.back());
}

}  // namespace vdbfuse
