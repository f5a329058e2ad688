// SPDX-License-Identifier: Apache-2.0
// An octree's cells read as dense blocks of any of its levels.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vdbfuse/octree/graph.h"

namespace vdbfuse {

/// 8³ cells of one level, in the order of leafOffset().
struct PyramidBlock {
  static constexpr std::uint8_t kMixed = 0xfe;        ///< the octree is finer here
  static constexpr std::uint8_t kBeyond = 0xff;       ///< outside the domain
  std::array<float, ScalarGrid::kLeafSize> solid;     ///< share of the cell that is labelled inside
  std::array<float, ScalarGrid::kLeafSize> evidence;  ///< λ σ · side: what an inside cell pays, in its faces
  std::array<float, ScalarGrid::kLeafSize> support;       ///< mean of C
  std::array<std::uint8_t, ScalarGrid::kLeafSize> level;  ///< of the octree's cell that holds it
};

/// Positions count cells of the level from the lowest corner of the octree's domain.
class CellPyramid {
 public:
  /// Keeps references. `support`, `sigma`: a cell each.
  CellPyramid(const Octree& octree, const std::vector<CellLabel>& labels, const std::vector<float>& support,
              const std::vector<float>& sigma, const CutOptions& energy)
      : octree_(octree), labels_(labels), support_(support), sigma_(sigma), energy_(energy) {}

  const Octree& octree() const { return octree_; }
  const CutOptions& energy() const { return energy_; }
  /// REQUIRES: `origin` is a multiple of 8; level ≤ octree.max_level.
  void read(int level, const Index3& origin, PyramidBlock& out) const;
  /// 1 inside, 0 outside; free borders count as outside.
  float beyond() const { return energy_.border == Border::Solid ? 1.0f : 0.0f; }
  float supportOf(std::size_t cell) const { return support_[cell]; }
  float solidAt(std::size_t cell) const { return labels_[cell] == CellLabel::Inside ? 1.0f : 0.0f; }

 private:
  void add(int level, const Index3& origin, std::size_t cell, PyramidBlock& out) const;

  const Octree& octree_;
  const std::vector<CellLabel>& labels_;
  const std::vector<float>& support_;
  const std::vector<float>& sigma_;
  CutOptions energy_;
};

}  // namespace vdbfuse
