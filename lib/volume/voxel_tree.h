// SPDX-License-Identifier: Apache-2.0
// Sparse voxels of several numbers each that grow while they are in use: an OpenVDB tree whose leaves keep
// their number.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// `Channels` numbers of type T a voxel, interleaved, in leaves of 8³ voxels. Instantiated for <float, 2>,
/// <std::int16_t, 2> and <std::uint16_t, 4>.
template <class T, int Channels>
class VoxelTree {
 public:
  static constexpr std::size_t kLeafValues = static_cast<std::size_t>(ScalarGrid::kLeafSize * Channels);

  VoxelTree();
  ~VoxelTree();
  VoxelTree(VoxelTree&&) noexcept;
  VoxelTree& operator=(VoxelTree&&) noexcept;

  /// Leaves are numbered 0, 1, … in the order in which they were inserted.
  std::size_t leafCount() const;
  Index3 origin(std::size_t leaf) const;
  /// kLeafValues numbers: those of the voxel at leafOffset(i) from i·Channels on. They stay where they are.
  T* values(std::size_t leaf) const;
  /// Not while another thread inserts.
  std::optional<std::uint32_t> find(const Index3& origin) const;
  /// find() of many: faster where they are near each other.
  void find(std::span<const Index3> origins, std::optional<std::uint32_t>* numbers) const;
  /// The number of a new leaf, all zero. REQUIRES: multiples of 8; no leaf is there.
  std::uint32_t insert(const Index3& origin);
  std::size_t memoryBytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
