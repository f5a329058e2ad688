// SPDX-License-Identifier: Apache-2.0
// What a level of the completion begins with.
#pragma once

#include <vector>

#include "surface/completion_level.h"

namespace vdbfuse {

/// Values of a block of one level.
struct StartBlock {
  static constexpr float kBeyondDomain = -1.0f;
  std::array<float, kBlockSize> u;
  std::array<float, kBlockSize> evidence;  ///< f
  std::array<float, kBlockSize> support;   ///< C; kBeyondDomain outside the domain
  std::array<float, kBlockSize> may_move;  ///< 1 where nothing was measured
};

/// What was measured, of finest voxels.
struct CompletionData {
  const ScalarGrid& support;  ///< C
  float supported;            ///< less does not support a surface
  /// Signed distances, 512 a block, origins in grid coordinates; kUnknown where nothing was measured.
  const BlockSet& blocks;
  const std::vector<float>& distances;
};

class CompletionStart {
 public:
  /// Keeps references. `levels`: finest first; those coarser than the one that is asked for are done.
  CompletionStart(const CellPyramid& pyramid, const std::vector<CompletionLevel>& levels,
                  const CompletionData& data)
      : pyramid_(pyramid), levels_(levels), data_(data) {}

  void read(int level, const Index3& origin, StartBlock& out) const;
  bool isCoarsest(int level) const { return level + 1 == static_cast<int>(levels_.size()); }
  bool mayMove(int level, std::size_t cell) const {
    return pyramid_.octree().levels[cell] >= level && pyramid_.supportOf(cell) < data_.supported;
  }

 private:
  void readCoarser(int level, const Index3& origin, const PyramidBlock& cells, StartBlock& out) const;
  void readMeasurements(const Index3& origin, const PyramidBlock& cells, StartBlock& out) const;

  const CellPyramid& pyramid_;
  const std::vector<CompletionLevel>& levels_;
  CompletionData data_;
};

/// Voxels over which u of measured cells falls from 1 to 0: u = ½ − distance/kRampVoxels there.
inline constexpr float kRampVoxels = 4.0f;

}  // namespace vdbfuse
