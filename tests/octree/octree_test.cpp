// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/octree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "octree/random_octree.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::forEachVoxel;
using test::RandomOctree;
using test::randomOctree;
using test::supportAt;

constexpr int kSeeds = 12;
// Domains of 8 to 40 voxels a side.
RandomOctree smallOctree(int seed) { return randomOctree(static_cast<std::uint64_t>(seed), 24, 3); }

TEST(Morton, PositionsComeBackAndOrderIsThatOfTheBits) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Index3 p(static_cast<int>(random.below(1 << 21)), static_cast<int>(random.below(1 << 21)),
                   static_cast<int>(random.below(1 << 21)));
    EXPECT_EQ(mortonPosition(mortonCode(p)), p);
  }
  EXPECT_EQ(mortonCode({1, 0, 0}), 1u);
  EXPECT_EQ(mortonCode({0, 1, 0}), 2u);
  EXPECT_EQ(mortonCode({0, 0, 1}), 4u);
  EXPECT_EQ(mortonCode({3, 1, 0}), 11u);
  const int last = (1 << 21) - 1;
  EXPECT_EQ(mortonCode({last, last, last}), (std::uint64_t{1} << 63) - 1);
}

TEST(Octree, CellsTileTheDomain) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Octree octree = smallOctree(seed).octree;
    std::vector<std::size_t> covered(octree.cellCount(), 0);
    forEachVoxel(octree, [&](const Index3& v) {
      const auto cell = octree.find(v);
      ASSERT_TRUE(cell);
      const Index3 local = v - octree.lowest(*cell);
      ASSERT_TRUE((local.array() >= 0).all() && (local.array() < octree.side(*cell)).all());
      ++covered[*cell];
    });
    for (std::size_t c = 0; c < covered.size(); ++c)
      ASSERT_EQ(covered[c], std::size_t{1} << (3 * octree.levels[c]));
    const auto by_level = cellsByLevel(octree);
    EXPECT_EQ(std::accumulate(by_level.begin(), by_level.end(), std::size_t{0}), octree.cellCount());
    EXPECT_FALSE(octree.find(octree.origin - Index3(1, 0, 0)));
    EXPECT_FALSE(octree.find(octree.origin + octree.size));
  }
}

TEST(Octree, NeighboursDifferByOneLevelAcrossFacesEdgesAndCorners) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Octree octree = smallOctree(seed).octree;
    forEachVoxel(octree, [&](const Index3& v) {
      const int level = octree.levels[*octree.find(v)];
      for (int n = 0; n < 27; ++n) {
        const auto other = octree.find(v + Index3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
        if (other) {
          ASSERT_LE(std::abs(octree.levels[*other] - level), 1) << seed;
        }
      }
    });
  }
}

TEST(Octree, SupportedVoxelsAreFinestWithTwoMoreAround) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const RandomOctree random = smallOctree(seed);
    for (const Index3& v : random.voxels) {
      for (int n = 0; n < 125; ++n) {
        const auto cell = random.octree.find(v + Index3(n % 5 - 2, n / 5 % 5 - 2, n / 25 - 2));
        if (cell) {
          ASSERT_EQ(random.octree.levels[*cell], 0) << seed;
        }
      }
    }
  }
}

TEST(Octree, CoversTheDomainInWholeCoarsestCellsAndWholeLeaves) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(seed);
    const int max_level = static_cast<int>(random.below(6));
    const GridFrame frame{0.1, {0.3, -0.2, 7}};
    const Eigen::Vector3d low(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5));
    const Box domain(low,
                     low + Eigen::Vector3d(random.uniform(0, 3), random.uniform(0, 3), random.uniform(0, 3)));
    const Octree octree = buildOctree(supportAt({}, frame), 0.5f, domain, {max_level});
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(octree.size[axis] % std::max(8, 1 << max_level), 0);
      EXPECT_EQ(octree.origin[axis] & 7, 0);
      EXPECT_LE(frame.toWorld(octree.origin)[axis], domain.min()[axis] + 1e-12);
      EXPECT_GE(frame.toWorld(Index3(octree.origin + octree.size))[axis], domain.max()[axis] + 0.1 - 1e-9);
      // Not more than what rounding to whole cells and leaves costs.
      EXPECT_LE(octree.size[axis], domain.sizes()[axis] / 0.1 + 2 + 2 * std::max(8, 1 << max_level));
    }
    EXPECT_EQ(cellsByLevel(octree).back(), octree.cellCount());
  }
}

TEST(Octree, VoxelsOutsideTheDomainOrBelowTheThresholdAreIgnored) {
  const Box domain(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(30, 30, 30));
  const Octree outside = buildOctree(supportAt({{100, 0, 0}}), 0.5f, domain, {3});
  EXPECT_EQ(cellsByLevel(outside)[0], 0u);
  const Octree below = buildOctree(supportAt({{10, 10, 10}}), 1.5f, domain, {3});
  EXPECT_EQ(cellsByLevel(below)[0], 0u);
  const Octree at = buildOctree(supportAt({{10, 10, 10}}), 1.0f, domain, {3});
  EXPECT_GT(cellsByLevel(at)[0], 0u);
}

TEST(Octree, OnlyTheRidgeIsFinestWhereAsked) {
  // A sheet x = 20 whose support falls off over many voxels, beside a weaker one far away.
  std::vector<Index3> voxels;
  for (int x = 0; x < 64; ++x)
    for (int y = 0; y < 64; ++y)
      for (int z = 0; z < 64; ++z) voxels.emplace_back(x, y, z);
  const ScalarGrid support = supportAt(voxels);
  support.forEachLeaf([](const ScalarGrid::Leaf& leaf) {
    for (int x = 0; x < 8; ++x) {
      const double strong = 12 * std::exp(-std::pow((leaf.origin.x() + x - 20) / 4.0, 2));
      const double weak = 0.8 * std::exp(-std::pow((leaf.origin.x() + x - 50) / 4.0, 2));
      for (int k = 0; k < 64; ++k) leaf.at(x, k / 8, k % 8) = static_cast<float>(strong + weak);
    }
  });
  const Box domain(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(63, 63, 63));
  const auto level = [&](const Octree& octree, int x) {
    return static_cast<int>(octree.levels[*octree.find({x, 30, 30})]);
  };
  const Octree all = buildOctree(support, 0.3f, domain, {4});
  const Octree ridge = buildOctree(support, 0.3f, domain, {4, 8, 0.5f});
  for (const int x : {12, 28}) EXPECT_EQ(level(all, x), 0);
  for (const int x : {17, 20, 23, 47, 50, 53}) EXPECT_EQ(level(ridge, x), 0) << x;
  for (const int x : {12, 28, 40, 60}) EXPECT_GT(level(ridge, x), 0) << x;
  EXPECT_LT(cellsByLevel(ridge)[0], 0.8 * static_cast<double>(cellsByLevel(all)[0]));
}

TEST(Octree, RefinedDividesTheCellsAskedForAndStaysGraded) {
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Octree octree = randomOctree(static_cast<std::uint64_t>(seed), 40, 4).octree;
    Random random(static_cast<std::uint64_t>(seed), 3);
    std::vector<std::size_t> asked;
    for (int i = 0; i < 5; ++i) asked.push_back(random.below(octree.cellCount()));
    const Octree finer = refined(octree, asked);
    std::vector<int> finest(octree.cellCount(), 64);
    forEachVoxel(octree, [&](const Index3& v) {
      const std::size_t old = *octree.find(v), cell = *finer.find(v);
      ASSERT_LE(finer.levels[cell], octree.levels[old]) << seed;
      finest[old] = std::min<int>(finest[old], finer.levels[cell]);
      for (int n = 0; n < 27; ++n) {
        const auto other = finer.find(v + Index3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
        if (other) {
          ASSERT_LE(std::abs(finer.levels[*other] - finer.levels[cell]), 1) << seed;
        }
      }
    });
    for (const std::size_t c : asked) EXPECT_EQ(finest[c]<octree.levels[c], octree.levels[c]> 0) << seed;
    EXPECT_EQ(refined(finer, {}).codes, finer.codes);
    EXPECT_EQ(refined(finer, {}).levels, finer.levels);
  }
}

TEST(Octree, DomainsThatCannotBeAreRefused) {
  const ScalarGrid support = supportAt({});
  EXPECT_THROW(buildOctree(support, 0.5f, Box()), InvalidArgument);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_THROW(buildOctree(support, 0.5f, Box(zero, Eigen::Vector3d(2e6, 1, 1))), InvalidArgument);
  // Far away: indices would not fit.
  const Eigen::Vector3d far(4e9, 0, 0);
  EXPECT_THROW(buildOctree(support, 0.5f, Box(far, Eigen::Vector3d(4e9 + 10, 1, 1))), InvalidArgument);
}

TEST(Octree, LevelGridsHoldEachCellsValueAtItsCentre) {
  const RandomOctree random = randomOctree(3);
  const Octree& octree = random.octree;
  std::vector<float> values;
  for (std::size_t c = 0; c < octree.cellCount(); ++c) values.push_back(static_cast<float>(c) + 1);
  const std::vector<ScalarGrid> grids = levelGrids(octree, values, "sigma", -1.0f);
  std::size_t checked = 0;
  for (const ScalarGrid& grid : grids) {
    const int level = static_cast<int>(std::lround(std::log2(grid.frame().voxel)));
    EXPECT_EQ(grid.name(), level == 0 ? "sigma" : "sigma_level" + std::to_string(level));
    for (std::size_t c = 0; c < octree.cellCount(); ++c) {
      if (octree.levels[c] != level) continue;
      const Eigen::Vector3d centre = octree.lowest(c).cast<double>().array() + 0.5 * (octree.side(c) - 1);
      const Eigen::Vector3d index = grid.frame().toIndex(octree.frame.toWorld(centre));
      EXPECT_LT((index - index.array().round().matrix()).norm(), 1e-9);
      EXPECT_EQ(grid.at(index.array().round().cast<int>().matrix()), values[c]);
      ++checked;
    }
  }
  EXPECT_EQ(checked, octree.cellCount());
}

}  // namespace
}  // namespace vdbfuse
