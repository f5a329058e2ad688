// SPDX-License-Identifier: Apache-2.0
// The two halves of an iteration of variation.h on one block, compiled for each instruction set.
#pragma once

#include "surface/block_set.h"

namespace vdbfuse {

/// Dual variables of a block: [corner][cube], corner = 4 dx + 2 dy + dz.
inline constexpr std::size_t kDualSize = 8 * BlockSet::kBlockSize;

/// Rows of 8 cells along z: bit 8 x + y of a block is set where there is something to do.
using RowMask = std::uint64_t;

/// The dual variables of the cubes that touch a block's cells: those of the block at the step −(dx, dy, dz)
/// in below[4 dx + 2 dy + dz].
struct DualPatch {
  const float* below[8];
};

/// p ← projection of p + s K ū onto |p| ≤ ρ̄, s = ½, in a block's cubes.
void ascend(const PaddedBlock<0, 1>& ahead, const float* price, RowMask rows, float* dual);

/// u⁺ = u − τ (Kᵀp + f) within [0, 1], τ = ½ where free; ahead = 2 u⁺ − u.
void descend(const DualPatch& dual, const float* evidence, const float* free, RowMask rows, float* u,
             float* ahead);

/// Kᵀp + f of all cells of a block.
void slopes(const DualPatch& dual, const float* evidence, float* out);

}  // namespace vdbfuse
