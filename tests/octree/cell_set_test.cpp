// SPDX-License-Identifier: Apache-2.0
#include "octree/cell_set.h"

#include <gtest/gtest.h>

#include <set>

#include "octree/local_maximum.h"
#include "octree/random_octree.h"

namespace vdbfuse {
namespace {

constexpr std::uint64_t kSeeds = 20;

// The same sets as a container of the standard library holds them.
using Cells = std::set<std::uint64_t>;

struct RandomSet {
  Index3 size;
  Cells cells;
  CellSet set;
  explicit RandomSet(std::uint64_t seed) {
    Random random(seed);
    for (int a = 0; a < 3; ++a) size[a] = 1 + static_cast<int>(random.below(14));
    for (int i = 0; i < 12; ++i) {
      const auto below = [&](int a) {
        return static_cast<int>(random.below(static_cast<std::uint64_t>(size[a])));
      };
      const int x = below(0), y = below(1), z = below(2);
      cells.insert(mortonCode({x, y, z}));
    }
    set = cellSet(std::vector<std::uint64_t>(cells.begin(), cells.end()));
  }
};

Cells listed(const CellSet& set) {
  Cells cells;
  std::uint64_t before = 0;
  forEachCell(set, [&](std::uint64_t code) {
    EXPECT_TRUE(cells.empty() || code > before);
    cells.insert(before = code);
  });
  return cells;
}

TEST(CellSet, HoldsWhatItWasMadeOfInMortonOrder) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomSet random(seed);
    EXPECT_EQ(listed(random.set), random.cells);
    EXPECT_EQ(cellCount(random.set), random.cells.size());
    for (std::uint64_t code = 0; code < 4096; ++code)
      ASSERT_EQ(holds(random.set, code), random.cells.contains(code));
  }
}

TEST(CellSet, DilationReachesAll26NeighboursInsideTheDomain) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomSet random(seed);
    Cells expected;
    for (const std::uint64_t code : random.cells) {
      for (int n = 0; n < 27; ++n) {
        const Index3 p = mortonPosition(code) + Index3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
        if ((p.array() >= 0).all() && (p.array() < random.size.array()).all()) expected.insert(mortonCode(p));
      }
    }
    EXPECT_EQ(listed(dilated(random.set, random.size)), expected) << seed;
  }
}

TEST(CellSet, ParentsAndChildrenAreShiftsOfTheCode) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomSet random(seed);
    Cells above, below;
    for (const std::uint64_t code : random.cells) {
      above.insert(code >> 3);
      for (std::uint64_t k = 0; k < 8; ++k) below.insert(code << 3 | k);
    }
    EXPECT_EQ(listed(parents(random.set)), above);
    EXPECT_EQ(listed(children(random.set)), below);
  }
}

TEST(CellSet, UnionAndDifferenceAreThoseOfSets) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const RandomSet a(seed), b(seed + 1000);
    Cells both = a.cells, left = a.cells;
    both.insert(b.cells.begin(), b.cells.end());
    for (const std::uint64_t code : b.cells) left.erase(code);
    EXPECT_EQ(listed(united(a.set, b.set)), both);
    EXPECT_EQ(listed(without(a.set, b.set)), left);
  }
}

TEST(CellSet, AllCellsAreThoseOfTheDomain) {
  for (const Index3& size : {Index3(1, 1, 1), Index3(4, 8, 4), Index3(5, 2, 11)}) {
    const Cells cells = listed(allCells(size));
    EXPECT_EQ(cells.size(), static_cast<std::size_t>(size.prod()));
    for (const std::uint64_t code : cells) EXPECT_TRUE((mortonPosition(code).array() < size.array()).all());
  }
}

TEST(LocalMaximum, IsTheLargestValueOfACubeAcrossLeaves) {
  std::vector<Index3> one_each;
  for (int n = 0; n < 27; ++n) one_each.emplace_back(8 * Index3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
  const ScalarGrid grid = test::supportAt(one_each);
  Random random(3);
  for (std::size_t i = 0; i < grid.leafCount(); ++i)
    for (float& value : grid.leaf(i).values) value = static_cast<float>(random.uniform());
  for (const int radius : {0, 1, 3, 8}) {
    const ScalarGrid largest = localMaximum(grid, radius);
    ASSERT_EQ(largest.leafCount(), grid.leafCount());
    for (const Index3& v : {Index3(0, 0, 0), Index3(7, 7, 7), Index3(3, 0, 7), Index3(5, 4, 2)}) {
      float expected = 0;
      for (int x = -radius; x <= radius; ++x)
        for (int y = -radius; y <= radius; ++y)
          for (int z = -radius; z <= radius; ++z) expected = std::max(expected, grid.at(v + Index3(x, y, z)));
      EXPECT_EQ(largest.at(v), expected) << radius;
    }
  }
}

}  // namespace
}  // namespace vdbfuse
