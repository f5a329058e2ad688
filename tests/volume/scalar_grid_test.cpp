// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/volume/scalar_grid.h"

#include <gtest/gtest.h>

#include <map>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/random.h"

namespace vdbfuse {
namespace {

const GridFrame kFrame{0.5, {1, -2, 3}};

TEST(ScalarGrid, TheValueLiesAtTheIntegerIndex) {
  EXPECT_EQ(kFrame.toWorld(Index3(0, 0, 0)), Eigen::Vector3d(1, -2, 3));
  EXPECT_EQ(kFrame.toWorld(Index3(2, -4, 1)), Eigen::Vector3d(2, -4, 3.5));
  EXPECT_EQ(kFrame.toIndex({2, -4, 3.5}), Eigen::Vector3d(2, -4, 1));
}

TEST(ScalarGrid, LeavesAreSortedUniqueAndFullOfBackground) {
  const ScalarGrid grid("g", kFrame, 7.0f, {{8, 0, 0}, {0, -8, 0}, {8, 0, 0}, {0, 0, 0}, {-8, 64, 0}});
  ASSERT_EQ(grid.leafCount(), 4u);
  const std::vector<Index3> expected = {{-8, 64, 0}, {0, -8, 0}, {0, 0, 0}, {8, 0, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(grid.leaf(i).origin, expected[i]);
    EXPECT_EQ(grid.findLeaf(expected[i]), i);
    for (const float v : grid.leaf(i).values) EXPECT_EQ(v, 7.0f);
  }
  EXPECT_FALSE(grid.findLeaf({16, 0, 0}));
  EXPECT_EQ(grid.at({100, 100, 100}), 7.0f);
  EXPECT_EQ(leafOrigin({-1, 7, 8}), Index3(-8, 0, 8));
}

TEST(ScalarGrid, AVoxelIsTheSameInItsLeafAndByItsIndex) {
  ScalarGrid grid("g", kFrame, 0.0f, {{0, 0, 0}, {-8, 0, 8}});
  grid.forEachLeaf([](const ScalarGrid::Leaf& leaf) {
    for (int x = 0; x < 8; ++x)
      for (int y = 0; y < 8; ++y)
        for (int z = 0; z < 8; ++z)
          leaf.at(x, y, z) = static_cast<float>((leaf.origin.x() + x) * 10000 + (leaf.origin.y() + y) * 100 +
                                                leaf.origin.z() + z);
  });
  EXPECT_EQ(grid.at({3, 4, 5}), 30405.0f);
  EXPECT_EQ(grid.at({-1, 7, 15}), -10000.0f + 700 + 15);
  EXPECT_EQ(grid.at({-1, 0, 0}), 0.0f);
}

TEST(ScalarGrid, InterpolationIsExactForTrilinearFunctions) {
  ScalarGrid grid("g", kFrame, 0.0f, {{0, 0, 0}, {8, 0, 0}});
  const auto f = [](const Eigen::Vector3d& p) {
    return 1 + p.x() - 2 * p.y() + 0.5 * p.z() + 0.25 * p.x() * p.y() * p.z();
  };
  grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const Index3 v = leaf.origin + Index3(k / 64, k / 8 % 8, k % 8);
      leaf.values[static_cast<std::size_t>(k)] = static_cast<float>(f(v.cast<double>()));
    }
  });
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(random.uniform(0, 15), random.uniform(0, 7), random.uniform(0, 7));
    EXPECT_NEAR(grid.interpolate(p), f(p), 1e-4 * (1 + std::abs(f(p))));
  }
  EXPECT_EQ(grid.interpolate({3, 4, 5}), grid.at({3, 4, 5}));
}

TEST(ScalarGrid, AVoxelSizeThatIsNotPositiveIsRefused) {
  EXPECT_THROW(ScalarGrid("g", GridFrame{0.0}, 0.0f), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
