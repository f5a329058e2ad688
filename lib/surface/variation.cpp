// SPDX-License-Identifier: Apache-2.0
#include "surface/variation.h"

#include <cmath>

#include "surface/variation_kernels.h"

namespace vdbfuse {
namespace {

// What there is to do in each block, and the prices of the cubes that matter.
struct Activity {
  std::vector<RowMask> cubes, cells;
  std::vector<float> price;  ///< 0 where no corner is free
};

RowMask rowsWith(const float* values) {
  RowMask rows = 0;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    if (values[i] > 0) rows |= RowMask{1} << (i / 8);
  }
  return rows;
}

Activity activityOf(const VariationProblem& problem) {
  const BlockSet& blocks = *problem.blocks;
  Activity activity{std::vector<RowMask>(blocks.count()), std::vector<RowMask>(blocks.count()),
                    std::vector<float>(blocks.valueCount(), 0.0f)};
  forEachBlock(blocks.count(), [&](std::size_t b) {
    PaddedBlock<0, 1> free;
    loadPadded(blocks, problem.free.data(), b, -100.0f, free);  // a cube that reaches out sums to < 0
    float* price = &activity.price[b * kBlockSize];
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      const float* corner =
          &free.at(static_cast<int>(i >> 6), static_cast<int>(i >> 3 & 7), static_cast<int>(i & 7));
      float sum = 0;
      for (const std::size_t dx : {std::size_t{0}, PaddedBlock<0, 1>::place(1, 0, 0)}) {
        for (const std::size_t dy : {std::size_t{0}, PaddedBlock<0, 1>::place(0, 1, 0)})
          sum += corner[dx + dy] + corner[dx + dy + 1];
      }
      if (sum > 0) price[i] = problem.price[b * kBlockSize + i];
    }
    activity.cubes[b] = rowsWith(price);
    activity.cells[b] = rowsWith(&problem.free[b * kBlockSize]);
  });
  return activity;
}

DualPatch patchOf(const BlockSet& blocks, const VariationState& state, std::size_t block) {
  static const std::vector<float> zeros(kDualSize, 0.0f);
  DualPatch patch;
  for (int c = 0; c < 8; ++c) {
    const std::uint32_t from = blocks.neighbour(block, -(c >> 2), -(c >> 1 & 1), -(c & 1));
    const std::uint32_t slot = from == kNoBlock ? kNoBlock : state.dual_of[from];
    patch.below[c] = slot == kNoBlock ? zeros.data() : &state.dual[slot * kDualSize];
  }
  return patch;
}

void makeRoom(const Activity& activity, VariationState& state) {
  const std::size_t blocks = activity.cubes.size();
  state.dual_of.resize(blocks, kNoBlock);
  auto slots = static_cast<std::uint32_t>(state.dual.size() / kDualSize);
  for (std::size_t b = 0; b < blocks; ++b) {
    if (activity.cubes[b] != 0 && state.dual_of[b] == kNoBlock) state.dual_of[b] = slots++;
  }
  state.dual.resize(slots * kDualSize, 0.0f);
  forEachBlock(blocks, [&](std::size_t b) {
    if (state.dual_of[b] == kNoBlock) return;
    float* dual = &state.dual[state.dual_of[b] * kDualSize];
    for (std::size_t i = 0; i < kBlockSize; ++i) {
      if (activity.price[b * kBlockSize + i] > 0) continue;
      for (std::size_t corner = 0; corner < 8; ++corner) dual[dualPlace(i, corner)] = 0;
    }
  });
}

double variationOf(const PaddedBlock<0, 1>& u, const Index3& cube) {
  double sum = 0, squares = 0;
  for (int k = 0; k < 8; ++k) {
    const double value = u.at(cube.x() + (k >> 2), cube.y() + (k >> 1 & 1), cube.z() + (k & 1));
    sum += value, squares += value * value;
  }
  return std::sqrt(std::max(0.0, 0.5 * (squares - sum * sum / 8)));
}

VariationGap gapOfBlock(const VariationProblem& problem, const Activity& activity,
                        const VariationState& state, std::size_t b) {
  const BlockSet& blocks = *problem.blocks;
  VariationGap gap;
  PaddedBlock<0, 1> u;
  loadPadded(blocks, state.u.data(), b, 0.0f, u);
  std::array<float, kBlockSize> slope;
  slopes(patchOf(blocks, state, b), &problem.evidence[b * kBlockSize], slope.data());
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const std::size_t cell = b * kBlockSize + i;
    if (const double price = activity.price[cell]; price > 0) {
      const double variation = variationOf(u, leafOffset(static_cast<int>(i)));
      gap.primal += price * variation, gap.area += variation;
    }
    const double evidence = problem.evidence[cell], value = state.u[cell];
    if (problem.free[cell] > 0) {
      gap.primal += evidence * value;
      gap.dual += std::min(0.0f, slope[i]);
    } else {
      gap.dual += (slope[i] - evidence) * value;
    }
  }
  return gap;
}

}  // namespace

void makeRoom(const VariationProblem& problem, VariationState& state) {
  makeRoom(activityOf(problem), state);
}

void iterate(const VariationProblem& problem, int steps, VariationState& state) {
  const BlockSet& blocks = *problem.blocks;
  const Activity activity = activityOf(problem);
  makeRoom(activity, state);
  std::vector<float> ahead = state.u;
  for (int step = 0; step < steps; ++step) {
    forEachBlock(blocks.count(), [&](std::size_t b) {
      if (activity.cubes[b] == 0) return;
      PaddedBlock<0, 1> patch;
      loadPadded(blocks, ahead.data(), b, 0.0f, patch);
      ascend(patch, &activity.price[b * kBlockSize], activity.cubes[b],
             &state.dual[state.dual_of[b] * kDualSize]);
    });
    forEachBlock(blocks.count(), [&](std::size_t b) {
      if (activity.cells[b] == 0) return;
      descend(patchOf(blocks, state, b), &problem.evidence[b * kBlockSize], &problem.free[b * kBlockSize],
              activity.cells[b], &state.u[b * kBlockSize], &ahead[b * kBlockSize]);
    });
  }
}

VariationGap gapOf(const VariationProblem& problem, const VariationState& state) {
  const Activity activity = activityOf(problem);
  std::vector<VariationGap> parts(problem.blocks->count());
  forEachBlock(parts.size(), [&](std::size_t b) { parts[b] = gapOfBlock(problem, activity, state, b); });
  VariationGap sum;
  for (const VariationGap& part : parts)
    sum.primal += part.primal, sum.dual += part.dual, sum.area += part.area;
  return sum;
}

}  // namespace vdbfuse
