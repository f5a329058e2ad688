// SPDX-License-Identifier: Apache-2.0
// What a TsdfVolume consists of.
#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "fusion/tsdf_kernels.h"
#include "vdbfuse/fusion/tsdf.h"
#include "volume/voxel_tree.h"

namespace vdbfuse {

/// Weights are multiples of one over this.
inline constexpr float kTsdfWeightOne = kHalfWeight;

struct TsdfVolumeState {
  using SingleTree = VoxelTree<float, 2>;
  using HalfTree = VoxelTree<std::int16_t, 2>;
  using ColorTree = VoxelTree<std::uint16_t, 4>;

  TsdfVolumeState(const GridFrame& grid_frame, const TsdfOptions& tsdf_options)
      : frame(grid_frame), options(tsdf_options) {
    if (options.storage == TsdfStorage::Half) voxels.emplace<HalfTree>();
    if (options.colors == TsdfColors::Keep) colors.emplace();
  }

  std::size_t leafCount() const { return last_change.size(); }
  Index3 origin(std::size_t leaf) const {
    return std::visit([&](const auto& tree) { return tree.origin(leaf); }, voxels);
  }
  std::optional<std::uint32_t> find(const Index3& origin) const {
    return std::visit([&](const auto& tree) { return tree.find(origin); }, voxels);
  }
  std::uint32_t insert(const Index3& origin) {
    if (colors) colors->insert(origin);
    last_change.push_back(0);
    return std::visit([&](auto& tree) { return tree.insert(origin); }, voxels);
  }
  std::uint16_t* colorsOf(std::size_t leaf) const { return colors ? colors->values(leaf) : nullptr; }
  std::size_t memoryBytes() const {
    return std::visit([](const auto& tree) { return tree.memoryBytes(); }, voxels) +
           (colors ? colors->memoryBytes() : 0) + last_change.capacity() * sizeof(last_change[0]);
  }

  /// visit(i, distance, weight) for the voxels of a leaf.
  template <class Visit>
  void decode(std::size_t leaf, const Visit& visit) const {
    if (const SingleTree* single = std::get_if<SingleTree>(&voxels)) {
      const float* v = single->values(leaf);
      for (std::size_t i = 0; i < kTsdfLeaf; ++i) visit(i, v[2 * i], v[2 * i + 1]);
    } else {
      const std::int16_t* v = std::get<HalfTree>(voxels).values(leaf);
      const float scale = static_cast<float>(options.truncation) / kHalfOne;
      for (std::size_t i = 0; i < kTsdfLeaf; ++i)
        visit(i, static_cast<float>(v[2 * i]) * scale, static_cast<float>(v[2 * i + 1]) / kHalfWeight);
    }
  }

  GridFrame frame;
  TsdfOptions options;
  std::variant<SingleTree, HalfTree> voxels;
  std::optional<ColorTree> colors;         ///< leaves numbered like those of `voxels`
  std::vector<std::uint32_t> last_change;  ///< of each leaf: changes at that time
  std::uint32_t changes = 0;
  bool is_carved = false;
};

struct TsdfVolume::Impl {
  TsdfVolumeState state;
};

}  // namespace vdbfuse
