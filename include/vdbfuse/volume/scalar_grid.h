// SPDX-License-Identifier: Apache-2.0
// A sparse scalar field kept in an OpenVDB float grid. The value lies AT the integer index: world = offset +
// voxel·index.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vdbfuse {

using Index3 = Eigen::Vector3i;

/// Where the voxels of a grid lie in the world.
struct GridFrame {
  double voxel = 0.0;  ///< edge length, unit of the poses
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  Eigen::Vector3d toWorld(const Eigen::Vector3d& index) const { return offset + voxel * index; }
  Eigen::Vector3d toWorld(const Index3& index) const {
    return toWorld(Eigen::Vector3d(index.cast<double>()));
  }
  Eigen::Vector3d toIndex(const Eigen::Vector3d& world) const { return (world - offset) / voxel; }
};

/// Voxels that hold this are unknown: inactive on disk.
inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// What a grid's values mean to other OpenVDB tools.
enum class GridKind { Field, LevelSet };

class ScalarGrid {
 public:
  static constexpr int kLeafSide = 8;
  static constexpr int kLeafSize = kLeafSide * kLeafSide * kLeafSide;

  /// One 8³ block. values[(x·8 + y)·8 + z], x, y, z counted from `origin`.
  struct Leaf {
    Index3 origin;
    std::span<float, kLeafSize> values;
    float& at(int x, int y, int z) const { return values[static_cast<std::size_t>((x * 8 + y) * 8 + z)]; }
  };

  /// Leaves at the given origins (multiples of 8, any order, repeats allowed), all values `background`.
  ScalarGrid(std::string name, const GridFrame& frame, float background, std::vector<Index3> origins = {});
  ~ScalarGrid();
  ScalarGrid(ScalarGrid&&) noexcept;
  ScalarGrid& operator=(ScalarGrid&&) noexcept;

  const std::string& name() const;
  const GridFrame& frame() const;
  float background() const;
  /// Leaves in increasing order of (x, y, z) of their origins.
  std::size_t leafCount() const;
  Leaf leaf(std::size_t index) const;
  std::optional<std::size_t> findLeaf(const Index3& origin) const;
  /// The value at a voxel; background where there is no leaf.
  float at(const Index3& voxel) const;
  /// Trilinear interpolation at a continuous index.
  float interpolate(const Eigen::Vector3d& index) const;
  /// Calls `visit(leaf)` for every leaf, in parallel; each leaf has one owner.
  void forEachLeaf(const std::function<void(const Leaf&)>& visit) const;
  /// Bytes of the tree.
  std::size_t memoryBytes() const;

  /// Numbers and words that are written with the grid.
  std::map<std::string, std::string>& metadata();
  const std::map<std::string, std::string>& metadata() const;
  void setKind(GridKind kind);

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Origin of the leaf that holds a voxel.
inline Index3 leafOrigin(const Index3& voxel) { return {voxel.x() & ~7, voxel.y() & ~7, voxel.z() & ~7}; }

/// Writes grids into one .vdb file. Unknown voxels become inactive; in a field those equal to the background
/// do, too, and where the background itself is unknown it is 0 on disk, with a word in the metadata. The
/// background of a level set on disk is its largest distance. Throws IoError; leaves an existing file as it
/// was when it fails.
void writeGrids(const std::filesystem::path& path, const std::vector<const ScalarGrid*>& grids);

/// Reads a float grid by name, or the first one when `name` is empty, with its metadata. Inactive voxels hold
/// the background value, or kUnknown in a level set. Throws IoError.
ScalarGrid readGrid(const std::filesystem::path& path, const std::string& name = {});

/// Names of the grids in a file, in its order. Throws IoError.
std::vector<std::string> gridNames(const std::filesystem::path& path);

}  // namespace vdbfuse
