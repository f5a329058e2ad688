// SPDX-License-Identifier: Apache-2.0
#include "surface/fragments.h"

namespace vdbfuse {
namespace {

// Calls visit(step) for the neighbours across faces, and across edges, too, for insides.
template <class Visit>
void forEachStep(bool is_inside, const Visit& visit) {
  for (int n = 0; n < 27; ++n) {
    const Index3 step(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
    const int faces = step.cwiseAbs().sum();
    if (faces == 1 || (faces == 2 && is_inside)) visit(step);
  }
}

// The component of a voxel, sorted; nothing when it is larger or reaches out of the blocks.
std::optional<std::vector<std::size_t>> smallComponent(const BlockField& sides, std::size_t seed,
                                                       std::size_t most) {
  const float side = sides.values[seed];
  std::vector<std::size_t> found{seed};
  bool is_small = true;
  for (std::size_t next = 0; next < found.size() && is_small; ++next) {
    forEachStep(side < 0, [&](const Index3& step) {
      const std::optional<std::size_t> voxel = sides.blocks.neighbourOf(found[next], step);
      is_small &= voxel.has_value();
      if (!voxel || sides.values[*voxel] != side) return;
      if (std::find(found.begin(), found.end(), *voxel) != found.end()) return;
      found.push_back(*voxel);
    });
    is_small &= found.size() <= most;
  }
  if (!is_small) return std::nullopt;
  std::sort(found.begin(), found.end());
  return found;
}

bool touches(const BlockField& sides, const std::vector<float>& marks, std::size_t voxel) {
  if (marks[voxel] > 0) return true;
  bool any = false;
  forEachStep(false, [&](const Index3& step) {
    const std::optional<std::size_t> next = sides.blocks.neighbourOf(voxel, step);
    any |= next && marks[*next] > 0;
  });
  return any;
}

// Whether a voxel has no neighbour of its side on at least three sides: others are in large components.
bool isExposed(const PaddedBlock<1, 1>& near, const Index3& v) {
  int other = 0;
  for (int n = 0; n < 6; ++n)
    other += near.at(v + (n % 2 * 2 - 1) * Index3(Index3::Unit(n / 2))) == -near.at(v) ? 1 : 0;
  return other >= 3;
}

}  // namespace

std::size_t dropFragments(const std::vector<float>& invented, std::size_t most, BlockField& sides) {
  std::vector<std::vector<std::vector<std::size_t>>> parts(sides.blocks.count());
  forEachBlock(parts.size(), [&](std::size_t b) {
    PaddedBlock<1, 1> near;
    loadPadded(sides.blocks, sides.values.data(), b, 0.0f, near);
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const std::size_t seed = b * kBlockSize + i;
      if (!isExposed(near, leafOffset(static_cast<int>(i))) || !touches(sides, invented, seed)) continue;
      if (auto component = smallComponent(sides, seed, most)) parts[b].push_back(std::move(*component));
    }
  });
  std::vector<std::vector<std::size_t>> all;
  for (auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (const auto& component : all) {
    for (const std::size_t voxel : component) sides.values[voxel] = -sides.values[voxel];
  }
  return all.size();
}

}  // namespace vdbfuse
