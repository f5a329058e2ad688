// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "mincut/instances.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/mincut/network.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

using test::Family;
using test::GridInstance;

/// What a new view does to part of a grid: other values in a run of tiles.
std::vector<std::uint32_t> change(GridInstance& instance, std::uint64_t seed) {
  Random random(seed);
  const std::size_t tiles = instance.tiles.size();
  std::vector<std::uint32_t> changed(tiles / 8);
  std::iota(changed.begin(), changed.end(), static_cast<std::uint32_t>(random.below(tiles - changed.size())));
  for (const std::uint32_t tile : changed) {
    for (std::size_t node = std::size_t{tile} * 64; node < std::size_t{tile + 1} * 64; ++node) {
      instance.terminals[node] += static_cast<std::int64_t>(4000 * random.normal());
      for (auto& capacities : instance.capacities)
        capacities[node] = static_cast<std::int32_t>(capacities[node] * random.uniform());
    }
  }
  return changed;
}

TEST(Update, GivesTheCutThatSolvingAfreshGives) {
  for (const Family family : test::kFamilies) {
    GridInstance before = test::gridInstance(family, 24, 1);
    Network network = buildNetwork(before.source());
    solve(network);
    for (std::uint64_t round = 0; round < 6; ++round) {
      GridInstance after = before;
      const std::vector<std::uint32_t> changed = change(after, round);
      updateNetwork(network, before.source(), after.source(), changed);
      const MinCut cut = solve(network);
      EXPECT_TRUE(verify(after.source(), network, cut).certified()) << test::name(family);
      Network fresh = buildNetwork(after.source());
      const MinCut expected = solve(fresh);
      ASSERT_EQ(cut.flow, expected.flow) << test::name(family) << " round " << round;
      ASSERT_EQ(cut.source, expected.source) << test::name(family) << " round " << round;
      before = after;
    }
  }
}

TEST(Update, ListedEdgesMayChangeToo) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const test::MixedInstance before = test::mixedInstance(seed);
    test::MixedInstance after = before;
    Random random(seed, 3);
    for (NetworkEdge& edge : after.listed)
      edge.capacity = static_cast<std::int32_t>(random.below(12)),
      edge.reverse_capacity = static_cast<std::int32_t>(random.below(12));
    std::vector<std::uint32_t> changed = {0, 0};  // twice is once
    for (std::size_t slot = 0; slot < 64; ++slot) {
      after.values[0].terminal[slot] = static_cast<std::int64_t>(random.below(41)) - 20;
      after.values[0].forward[seed % 3][slot] = static_cast<std::int32_t>(random.below(8));
    }
    Network network = buildNetwork(before.source());
    solve(network);
    updateNetwork(network, before.source(), after.source(), changed);
    const MinCut cut = solve(network);
    EXPECT_TRUE(verify(after.source(), network, cut).certified()) << seed;
    Network fresh = buildNetwork(after.source());
    ASSERT_EQ(cut.source, solve(fresh).source) << seed;
  }
}

TEST(Update, ASmallChangeIsLittleWork) {
  GridInstance before = test::gridInstance(Family::LowContrast, 64, 1);
  Network network = buildNetwork(before.source());
  const SolveStatistics whole = solve(network).statistics;
  GridInstance after = before;
  for (std::uint32_t node = 64 * 2000; node < 64 * 2008; ++node) after.terminals[node] -= 3000;
  const std::vector<std::uint32_t> changed = {2000, 2001, 2002, 2003, 2004, 2005, 2006, 2007};
  updateNetwork(network, before.source(), after.source(), changed);
  const SolveStatistics part = solve(network).statistics;
  EXPECT_LT(20 * part.pushes, whole.pushes);
  EXPECT_LT(20 * part.adoptions, whole.adoptions);
}

TEST(Update, RefusesASourceThatTheNetworkWasNotBuiltWith) {
  const GridInstance before = test::gridInstance(Family::Carving, 16, 1);
  GridInstance other = before;
  other.capacities[0][0] += 1;
  Network network = buildNetwork(before.source());
  const std::vector<std::uint32_t> first = {0}, beyond = {64};
  EXPECT_THROW(updateNetwork(network, other.source(), before.source(), first), InvalidArgument);
  EXPECT_THROW(updateNetwork(network, before.source(), before.source(), beyond), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
