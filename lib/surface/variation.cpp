// SPDX-License-Identifier: Apache-2.0
#include "surface/variation.h"

#include <algorithm>
#include <cmath>

#include "surface/variation_kernels.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kSize = BlockSet::kBlockSize;
constexpr std::size_t kBlocksPerTask = 16;

// What there is to do in each block, and the prices of the cubes that matter.
struct Activity {
  std::vector<RowMask> cubes, cells;
  std::vector<float> price;  ///< 0 where no corner is free
};

RowMask rowsWith(const float* values) {
  RowMask rows = 0;
  for (std::size_t i = 0; i < kSize; ++i) {
    if (values[i] > 0) rows |= RowMask{1} << (i / 8);
  }
  return rows;
}

template <class Visit>
void forEachBlock(const BlockSet& blocks, const Visit& visit) {
  parallelFor(blocks.count(), kBlocksPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) visit(b);
  });
}

Activity activityOf(const VariationProblem& problem) {
  const BlockSet& blocks = *problem.blocks;
  Activity activity{std::vector<RowMask>(blocks.count()), std::vector<RowMask>(blocks.count()),
                    problem.price};
  forEachBlock(blocks, [&](std::size_t b) {
    PaddedBlock<0, 1> free;
    loadPadded(blocks, problem.free.data(), b, -100.0f, free);  // a cube that reaches out sums to < 0
    float* price = &activity.price[b * kSize];
    for (int i = 0; i < static_cast<int>(kSize); ++i) {
      const Index3 c = leafOffset(i);
      float sum = 0;
      for (int k = 0; k < 8; ++k) sum += free.at(c.x() + (k >> 2), c.y() + (k >> 1 & 1), c.z() + (k & 1));
      if (!(sum > 0)) price[i] = 0;
    }
    activity.cubes[b] = rowsWith(price);
    activity.cells[b] = rowsWith(&problem.free[b * kSize]);
  });
  return activity;
}

DualPatch patchOf(const BlockSet& blocks, const std::vector<float>& dual, std::size_t block) {
  static const std::vector<float> zeros(kDualSize, 0.0f);
  DualPatch patch;
  for (int c = 0; c < 8; ++c) {
    const std::uint32_t from = blocks.neighbour(block, -(c >> 2), -(c >> 1 & 1), -(c & 1));
    patch.below[c] = from == kNoBlock ? zeros.data() : &dual[from * kDualSize];
  }
  return patch;
}

// A cube that does not count any more has no dual variable.
void prepareDual(const VariationProblem& problem, const Activity& activity, VariationState& state) {
  const std::size_t blocks = problem.blocks->count();
  if (state.dual.empty()) {
    state.dual.assign(blocks * kDualSize, 0.0f);
    return;
  }
  forEachBlock(*problem.blocks, [&](std::size_t b) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      float* p = &state.dual[b * kDualSize + corner * kSize];
      for (std::size_t i = 0; i < kSize; ++i) {
        if (!(activity.price[b * kSize + i] > 0)) p[i] = 0;
      }
    }
  });
}

VariationGap gapOfBlock(const VariationProblem& problem, const Activity& activity,
                        const VariationState& state, std::size_t b) {
  const BlockSet& blocks = *problem.blocks;
  VariationGap gap;
  PaddedBlock<0, 1> u;
  loadPadded(blocks, state.u.data(), b, 0.0f, u);
  for (int i = 0; i < static_cast<int>(kSize); ++i) {
    const double price = activity.price[b * kSize + static_cast<std::size_t>(i)];
    if (!(price > 0)) continue;
    const Index3 c = leafOffset(i);
    double sum = 0, squares = 0;
    for (int k = 0; k < 8; ++k) {
      const double value = u.at(c.x() + (k >> 2), c.y() + (k >> 1 & 1), c.z() + (k & 1));
      sum += value, squares += value * value;
    }
    const double variation = std::sqrt(std::max(0.0, 0.5 * (squares - sum * sum / 8)));
    gap.primal += price * variation;
    gap.area += variation;
  }
  std::array<float, kSize> slope;
  slopes(patchOf(blocks, state.dual, b), &problem.evidence[b * kSize], slope.data());
  for (std::size_t i = 0; i < kSize; ++i) {
    const std::size_t cell = b * kSize + i;
    if (problem.free[cell] > 0) {
      gap.primal += static_cast<double>(problem.evidence[cell]) * state.u[cell];
      gap.dual += std::min(0.0f, slope[i]);
    } else {
      gap.dual += static_cast<double>(slope[i] - problem.evidence[cell]) * state.u[cell];
    }
  }
  return gap;
}

}  // namespace

void iterate(const VariationProblem& problem, int steps, VariationState& state) {
  const BlockSet& blocks = *problem.blocks;
  const Activity activity = activityOf(problem);
  prepareDual(problem, activity, state);
  std::vector<float> ahead = state.u;
  for (int step = 0; step < steps; ++step) {
    forEachBlock(blocks, [&](std::size_t b) {
      if (activity.cubes[b] == 0) return;
      PaddedBlock<0, 1> patch;
      loadPadded(blocks, ahead.data(), b, 0.0f, patch);
      ascend(patch, &activity.price[b * kSize], activity.cubes[b], &state.dual[b * kDualSize]);
    });
    forEachBlock(blocks, [&](std::size_t b) {
      if (activity.cells[b] == 0) return;
      descend(patchOf(blocks, state.dual, b), &problem.evidence[b * kSize], &problem.free[b * kSize],
              activity.cells[b], &state.u[b * kSize], &ahead[b * kSize]);
    });
  }
}

VariationGap gapOf(const VariationProblem& problem, const VariationState& state) {
  const Activity activity = activityOf(problem);
  std::vector<VariationGap> parts(problem.blocks->count());
  forEachBlock(*problem.blocks, [&](std::size_t b) { parts[b] = gapOfBlock(problem, activity, state, b); });
  VariationGap sum;
  for (const VariationGap& part : parts)
    sum.primal += part.primal, sum.dual += part.dual, sum.area += part.area;
  return sum;
}

}  // namespace vdbfuse
