// SPDX-License-Identifier: Apache-2.0
#include "volume/voxel_tree.h"

#include <gtest/gtest.h>

namespace vdbfuse {
namespace {

TEST(VoxelTree, LeavesKeepTheirNumberAndTheirPlace) {
  VoxelTree<float, 2> tree;
  EXPECT_EQ(tree.insert({0, 0, 0}), 0u);
  float* first = tree.values(0);
  for (std::size_t i = 0; i < tree.kLeafValues; ++i) EXPECT_EQ(first[i], 0.0f);
  first[2 * 77 + 1] = 5;
  for (int i = 1; i < 500; ++i) EXPECT_EQ(tree.insert({8 * i, -800 * i, 8}), static_cast<std::uint32_t>(i));
  EXPECT_EQ(tree.values(0), first);
  EXPECT_EQ(first[2 * 77 + 1], 5);
  EXPECT_EQ(tree.leafCount(), 500u);
  for (int i = 1; i < 500; ++i) {
    EXPECT_EQ(tree.find({8 * i, -800 * i, 8}), static_cast<std::uint32_t>(i));
    EXPECT_EQ(tree.origin(static_cast<std::size_t>(i)), Index3(8 * i, -800 * i, 8));
  }
  EXPECT_FALSE(tree.find({0, 0, 8}));
}

TEST(VoxelTree, TakesLittleMoreThanItsVoxels) {
  VoxelTree<std::int16_t, 2> tree;
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y) tree.insert({8 * x, 8 * y, 0});
  const double voxels = 400.0 * 512 * 4;
  EXPECT_GT(static_cast<double>(tree.memoryBytes()), voxels);
  EXPECT_LT(static_cast<double>(tree.memoryBytes()), 1.15 * voxels);
}

}  // namespace
}  // namespace vdbfuse
