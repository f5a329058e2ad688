// SPDX-License-Identifier: Apache-2.0
// The two halves of an iteration of variation.h on one block, compiled for each instruction set.
#pragma once

#include "surface/block_set.h"

namespace vdbfuse {

/// Dual variables of a block: [row][corner][z], row = 8 x + y, corner = 4 dx + 2 dy + dz.
inline constexpr std::size_t kDualSize = 8 * kBlockSize;
inline constexpr std::size_t dualPlace(std::size_t cube, std::size_t corner) {
  return cube / 8 * 64 + corner * 8 + cube % 8;
}

/// s τ ‖K‖² ≤ 1. Of the ratios 1/4, 1, 4 and 16 the fastest by a third.
inline constexpr float kDualStep = 1.0f, kPrimalStep = 0.25f;

/// Rows of 8 cells along z: bit 8 x + y of a block is set where there is something to do.
using RowMask = std::uint64_t;

/// The dual variables of the cubes that touch a block's cells: those of the block at the step −(dx, dy, dz)
/// in below[4 dx + 2 dy + dz].
struct DualPatch {
  const float* below[8];
};

/// p ← projection of p + s K ū onto |p| ≤ ρ̄ in a block's cubes.
void ascend(const PaddedBlock<0, 1>& ahead, const float* price, RowMask rows, float* dual);

/// u⁺ = u − τ (Kᵀp + f) within [0, 1] where free; ahead = 2 u⁺ − u.
void descend(const DualPatch& dual, const float* evidence, const float* free, RowMask rows, float* u,
             float* ahead);

/// Kᵀp + f of all cells of a block.
void slopes(const DualPatch& dual, const float* evidence, float* out);

}  // namespace vdbfuse
