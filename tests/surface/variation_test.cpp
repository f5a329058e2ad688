// SPDX-License-Identifier: Apache-2.0
#include "surface/variation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "surface/variation_kernels.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

// A cube of blocks, of which the outermost cells are frozen.
struct Instance {
  BlockSet blocks;
  VariationProblem problem;
  VariationState state;

  template <class Visit>
  void forEachCell(const Visit& visit) {
    for (std::size_t b = 0; b < blocks.count(); ++b)
      for (std::size_t i = 0; i < kBlockSize; ++i)
        visit(b * kBlockSize + i, Index3(blocks.origin(b) + leafOffset(static_cast<int>(i))));
  }
};

std::unique_ptr<Instance> instance(int side_blocks) {
  std::vector<Index3> origins;
  appendBlocks(Index3::Zero(), Index3::Constant(8 * side_blocks - 1), origins);
  auto result = std::make_unique<Instance>();
  result->blocks = BlockSet(origins);
  result->problem.blocks = &result->blocks;
  const std::size_t size = result->blocks.valueCount();
  result->problem.price.assign(size, 1.0f);
  result->problem.evidence.assign(size, 0.0f);
  result->problem.free.assign(size, 0.0f);
  result->state.u.assign(size, 0.0f);
  result->forEachCell([&](std::size_t i, const Index3& c) {
    if (c.minCoeff() > 0 && c.maxCoeff() < 8 * side_blocks - 1) result->problem.free[i] = 1;
  });
  return result;
}

std::unique_ptr<Instance> randomInstance(std::uint64_t seed) {
  auto result = instance(2);
  Random random(seed);
  result->forEachCell([&](std::size_t i, const Index3& c) {
    result->problem.price[i] = static_cast<float>(random.uniform(0.1, 1));
    result->problem.evidence[i] = static_cast<float>(random.uniform(-0.6, 0.6));
    result->state.u[i] = c.x() < 8 ? 1.0f : 0.0f;
  });
  return result;
}

TEST(Variation, OfARampIsItsSlopeInEveryDirection) {
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 1), Eigen::Vector3d(1, -2, 3)}) {
    auto ramp = instance(1);
    const Eigen::Vector3d slope = 0.02 * direction.normalized();
    ramp->forEachCell([&](std::size_t i, const Index3& c) {
      ramp->state.u[i] = static_cast<float>(0.5 + slope.dot(c.cast<double>()));
    });
    makeRoom(ramp->problem, ramp->state);
    const VariationGap gap = gapOf(ramp->problem, ramp->state);
    EXPECT_NEAR(gap.area, 7 * 7 * 7 * 0.02, 1e-4) << direction.transpose();
  }
}

TEST(Variation, TheMinimumLiesBetweenDualAndPrimalAndBothMeetThere) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    auto random = randomInstance(seed);
    double primal = 1e9, dual = -1e9;
    for (int round = 0; round < 30; ++round) {
      iterate(random->problem, 20, random->state);
      const VariationGap gap = gapOf(random->problem, random->state);
      primal = std::min(primal, gap.primal), dual = std::max(dual, gap.dual);
      ASSERT_LE(gap.dual, primal + 1e-3);
      ASSERT_GE(gap.primal, dual - 1e-3);
    }
    EXPECT_LT(primal - dual, 0.01 * std::abs(primal)) << seed;
  }
}

TEST(Variation, NoSmallMoveOfASolutionIsBetter) {
  auto random = randomInstance(7);
  iterate(random->problem, 2000, random->state);
  const VariationGap best = gapOf(random->problem, random->state);
  Random moves(1);
  for (int k = 0; k < 50; ++k) {
    VariationState moved = random->state;
    for (std::size_t i = 0; i < moved.u.size(); ++i) {
      if (random->problem.free[i] > 0 && moves.uniform() < 0.1)
        moved.u[i] = std::clamp(moved.u[i] + static_cast<float>(moves.uniform(-0.2, 0.2)), 0.0f, 1.0f);
    }
    EXPECT_GT(gapOf(random->problem, moved).primal, best.primal - 1e-2);
  }
}

TEST(Variation, FrozenCellsAndCubesBeyondTheBlocksDoNotMove) {
  auto random = randomInstance(2);
  const std::vector<float> before = random->state.u;
  iterate(random->problem, 50, random->state);
  std::size_t moved = 0;
  random->forEachCell([&](std::size_t i, const Index3&) {
    if (random->problem.free[i] > 0) {
      moved += random->state.u[i] != before[i];
    } else {
      ASSERT_EQ(random->state.u[i], before[i]);
    }
    ASSERT_GE(random->state.u[i], 0);
    ASSERT_LE(random->state.u[i], 1);
  });
  EXPECT_GT(moved, 500u);
}

TEST(Variation, IsTheSameForEveryNumberOfThreadsAndInPieces) {
  auto one = randomInstance(5), many = randomInstance(5);
  {
    const ThreadLimit limit(1);
    iterate(one->problem, 60, one->state);
  }
  const ThreadLimit limit(4);
  iterate(many->problem, 60, many->state);
  EXPECT_EQ(one->state.u, many->state.u);
  EXPECT_EQ(one->state.dual, many->state.dual);
}

}  // namespace
}  // namespace vdbfuse
