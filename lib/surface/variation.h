// SPDX-License-Identifier: Apache-2.0
// Weighted total variation on a sparse grid, whose ½-level is the minimal surface in the Euclidean metric:
//   min over u ∈ [0, 1] of  Σ_cubes 2 ρ̄ std(u at the 8 corners) + Σ_cells f u,      u = 1 inside
// (Chan, Esedoglu, Nikolova 2006, for (1) of Hernández et al. 2007). 2 std equals |∇u| on ramps, has no
// preferred direction and is blind to no pattern. By the primal-dual method of Chambolle and Pock (2011) with
// K u = (u_j − mean u)/√2 at the corners j of each cube: |K u| = 2 std, ‖K‖² ≤ 4.
#pragma once

#include <cstdint>
#include <vector>

#include "surface/block_set.h"

namespace vdbfuse {

/// Arrays of 512 values a block. Cells that are not in a block, and cubes that reach out of the blocks, do
/// not exist.
struct VariationProblem {
  const BlockSet* blocks = nullptr;
  /// ρ̄ of the cube whose lowest corner is the cell.
  std::vector<float> price;
  std::vector<float> evidence;  ///< f
  /// 1 where u may move, 0 where it is frozen.
  std::vector<float> free;
};

struct VariationState {
  std::vector<float> u;
  /// The dual variables p of the blocks in which cubes have a free corner, kDualSize each
  /// (variation_kernels.h), and where those of a block are, or kNoBlock. Empty: zero everywhere.
  std::vector<float> dual;
  std::vector<std::uint32_t> dual_of;
};

/// What is true of a state whatever it is: primal ≥ minimum ≥ dual.
struct VariationGap {
  double primal = 0, dual = 0;
  double area = 0;  ///< Σ 2 std over all cubes with a free corner, faces
};

/// Makes room for the dual variables that the problem's free cells need; those it needs no more become zero.
void makeRoom(const VariationProblem& problem, VariationState& state);

/// So many iterations. The same for every number of threads.
void iterate(const VariationProblem& problem, int steps, VariationState& state);

VariationGap gapOf(const VariationProblem& problem, const VariationState& state);

}  // namespace vdbfuse
