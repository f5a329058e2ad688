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

using Component = std::vector<std::size_t>;

// The component of a voxel, sorted; nothing when it is not small or reaches out of the blocks.
template <class IsSmall>
std::optional<Component> smallComponent(const BlockField& sides, std::size_t seed, const IsSmall& is_small) {
  const float side = sides.values[seed];
  Component found{seed};
  bool stays = true;
  for (std::size_t next = 0; next < found.size() && stays; ++next) {
    forEachStep(side < 0, [&](const Index3& step) {
      const std::optional<std::size_t> voxel = sides.blocks.neighbourOf(found[next], step);
      stays &= voxel.has_value();
      if (!voxel || sides.values[*voxel] != side) return;
      if (std::find(found.begin(), found.end(), *voxel) != found.end()) return;
      found.push_back(*voxel);
    });
    stays &= is_small(found);
  }
  if (!stays) return std::nullopt;
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

bool fitsIntoCube(const BlockSet& blocks, const Component& voxels, int width) {
  const auto place = [&](std::size_t voxel) {
    return Index3(blocks.origin(voxel / kBlockSize) + leafOffset(static_cast<int>(voxel % kBlockSize)));
  };
  Index3 low = place(voxels.front()), high = low;
  for (const std::size_t voxel : voxels) low = low.cwiseMin(place(voxel)), high = high.cwiseMax(place(voxel));
  return (high - low).maxCoeff() < width;
}

// Turns the components that find(seed) gives for exposed voxels. Returns how many there are.
template <class Find>
std::size_t turnComponents(const Find& find, BlockField& sides) {
  std::vector<std::vector<Component>> parts(sides.blocks.count());
  forEachBlock(parts.size(), [&](std::size_t b) {
    PaddedBlock<1, 1> near;
    loadPadded(sides.blocks, sides.values.data(), b, 0.0f, near);
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      if (!isExposed(near, leafOffset(static_cast<int>(i)))) continue;
      if (auto component = find(b * kBlockSize + i)) parts[b].push_back(std::move(*component));
    }
  });
  std::vector<Component> all;
  for (auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  for (const Component& component : all) {
    for (const std::size_t voxel : component) sides.values[voxel] = -sides.values[voxel];
  }
  return all.size();
}

}  // namespace

std::size_t dropFragments(const std::vector<float>& invented, std::size_t most, BlockField& sides) {
  const auto find = [&](std::size_t seed) -> std::optional<Component> {
    if (!touches(sides, invented, seed)) return std::nullopt;
    return smallComponent(sides, seed, [&](const Component& found) { return found.size() <= most; });
  };
  return turnComponents(find, sides);
}

std::size_t dropUnresolved(int width, BlockField& sides) {
  const auto fits = [&](const Component& found) { return fitsIntoCube(sides.blocks, found, width); };
  return turnComponents([&](std::size_t seed) { return smallComponent(sides, seed, fits); }, sides);
}

}  // namespace vdbfuse
