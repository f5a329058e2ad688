// SPDX-License-Identifier: Apache-2.0
// Cells of a multi-resolution grid: finest near the measurements, doubling with the distance from them,
// neighbours never more than one level apart. A linear octree: leaf cells only, in Morton order.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

/// The longest side of a domain in finest voxels (21 bits an axis in a Morton code).
inline constexpr int kMaxOctreeSide = 1 << 20;

/// Interleaves the bits of three coordinates in [0, 2²¹): x lowest.
std::uint64_t mortonCode(const Index3& position);
Index3 mortonPosition(std::uint64_t code);

struct Octree {
  GridFrame frame;         ///< of the finest voxels
  Index3 origin{0, 0, 0};  ///< lowest voxel of the domain, a multiple of 8
  Index3 size{0, 0, 0};    ///< voxels along each axis, multiples of 2^max_level
  int max_level = 0;       ///< a cell of level l covers 2^l voxels a side
  /// A cell each, in increasing order: Morton code of its lowest voxel, relative to `origin`.
  std::vector<std::uint64_t> codes;
  std::vector<std::uint8_t> levels;

  std::size_t cellCount() const { return codes.size(); }
  int side(std::size_t cell) const { return 1 << levels[cell]; }
  /// Lowest voxel of a cell, in the grid's own index coordinates.
  Index3 lowest(std::size_t cell) const { return origin + mortonPosition(codes[cell]); }
  /// The cell that holds a voxel; nothing outside the domain.
  std::optional<std::size_t> find(const Index3& voxel) const;
  /// First cell whose code is not below that of `voxel`. REQUIRES: inside the domain.
  std::size_t firstFrom(const Index3& voxel) const;
  bool contains(const Index3& voxel) const {
    return ((voxel - origin).array() >= 0).all() && ((voxel - origin).array() < size.array()).all();
  }
};

struct OctreeOptions {
  /// Coarsest cells are 2^max_level finest voxels wide. 6 keeps 15 bits for the capacities of the cut.
  int max_level = 6;
  /// Where C is smooth over many voxels, because the noise is wider than they are, only its ridge needs
  /// finest cells: those that hold `ridge_share` of the largest value within this many voxels along each axis
  /// (0 … 8). 0: all that the threshold lets pass.
  int ridge_radius = 0;
  float ridge_share = 0.5f;
};

/// Finest cells wherever a voxel of `support` holds at least `threshold`, and for two voxels around; then
/// cells that double with the distance, graded 2:1 across faces, edges and corners. `domain`: world box;
/// voxels outside it are ignored, and the octree covers it, rounded outwards to whole coarsest cells. Throws
/// InvalidArgument when the domain is empty, longer than kMaxOctreeSide or 1e9 voxels away.
Octree buildOctree(const ScalarGrid& support, float threshold, const Box& domain,
                   const OctreeOptions& options = {});

/// The octree with these cells divided, and what grading asks for. Finest cells stay.
Octree refined(const Octree& octree, const std::vector<std::size_t>& cells);

/// Number of cells of each level, finest first.
std::vector<std::size_t> cellsByLevel(const Octree& octree);

/// Values a cell as grids, one a level: voxel size 2^l h, the value at the centre of the cell. Grid names:
/// `name`, `name_level1`, …
std::vector<ScalarGrid> levelGrids(const Octree& octree, const std::vector<float>& values,
                                   const std::string& name, float background);

}  // namespace vdbfuse
