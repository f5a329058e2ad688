// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/cell_tiles.h"

#include <gtest/gtest.h>

#include <bit>
#include <set>

#include "mincut/oracles.h"
#include "octree/octree_instances.h"
#include "octree/random_octree.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

using test::randomOctree;

constexpr std::uint64_t kSeeds = 20;

TEST(CellTiles, EveryCellIsInOneSlotOfATileOfItsLevel) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Octree octree = randomOctree(seed).octree;
    const CellTiles tiles = tileCells(octree);
    std::set<std::uint32_t> seen;
    for (std::uint32_t node = 0; node < tiles.cells.size(); ++node) {
      const bool filled = (tiles.tiles[node / 64].nodes >> node % 64 & 1) != 0;
      ASSERT_EQ(filled, tiles.cells[node] != kNoCell);
      if (!filled) continue;
      EXPECT_TRUE(seen.insert(tiles.cells[node]).second);
      EXPECT_EQ(octree.levels[tiles.cells[node]], tiles.levels[node / 64]);
    }
    EXPECT_EQ(seen.size(), octree.cellCount());
  }
}

TEST(CellTiles, SlotsCountFromTheTilesLowestCornerXFirst) {
  const Octree octree = randomOctree(3).octree;
  const CellTiles tiles = tileCells(octree);
  for (std::uint32_t node = 0; node < tiles.cells.size(); ++node) {
    if (tiles.cells[node] == kNoCell) continue;
    const Index3 position =
        (octree.lowest(tiles.cells[node]) - octree.origin) / octree.side(tiles.cells[node]);
    EXPECT_EQ(node % 64,
              static_cast<unsigned>(position.x() % 4 + 4 * (position.y() % 4) + 16 * (position.z() % 4)));
  }
}

TEST(CellTiles, NeighboursAreTheTilesOfTheSameLevelBeyondTheFaces) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Octree octree = randomOctree(seed).octree;
    const CellTiles tiles = tileCells(octree);
    const auto corner = [&](std::uint32_t tile) -> Index3 {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(tiles.tiles[tile].nodes));
      const Index3 local(slot % 4, slot / 4 % 4, slot / 16);
      const std::uint32_t cell = tiles.cells[tile * 64 + slot];
      return octree.lowest(cell) - local * octree.side(cell);
    };
    std::size_t links = 0, expected = 0;
    for (std::uint32_t a = 0; a < tiles.count(); ++a) {
      for (std::size_t d = 0; d < 6; ++d) {
        const Index3 beyond =
            corner(a) + (d % 2 == 1 ? 4 : -4) * (1 << tiles.levels[a]) * Index3(Index3::Unit(d / 2));
        for (std::uint32_t b = 0; b < tiles.count(); ++b)
          expected += tiles.levels[b] == tiles.levels[a] && corner(b) == beyond;
        const std::uint32_t next = tiles.tiles[a].neighbours[d];
        if (next == kNoTile) continue;
        ++links;
        EXPECT_EQ(corner(next), beyond);
        EXPECT_EQ(tiles.levels[next], tiles.levels[a]);
      }
    }
    EXPECT_EQ(links, expected);
  }
}

TEST(CellTiles, OctreesOfAllFamiliesAreCutAsBoostCutsThem) {
  for (const test::OctreeFamily family : test::kOctreeFamilies) {
    const test::OctreeInstance instance = test::octreeInstance(family, 64, 1);
    const NetworkSource source = instance.source();
    Network network = buildNetwork(source);
    EXPECT_EQ(network.nodeCount(), instance.octree.cellCount());
    const MinCut cut = solve(network);
    EXPECT_TRUE(verify(source, network, cut).certified());
    EXPECT_EQ(cut.flow, test::BoostMaxFlow(instance.graph()).solve()) << test::name(family);
  }
}

}  // namespace
}  // namespace vdbfuse
