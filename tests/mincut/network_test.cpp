// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "mincut/instances.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

using testing::HasSubstr;

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "not refused";
}

std::string refusal(std::vector<NetworkEdge> edges) {
  return refusal([&] { buildNetwork(graphSource(std::vector<std::int64_t>(3), edges)); });
}

/// Two tiles of all nodes, the second in +y.
NetworkSource twoTiles() {
  NetworkSource source;
  source.tiles.resize(2);
  source.tiles[0].nodes = source.tiles[1].nodes = ~std::uint64_t{0};
  source.tiles[0].neighbours[3] = 1;
  source.tiles[1].neighbours[2] = 0;
  source.capacities = [](std::uint32_t, TileCapacities&) {};
  return source;
}

TEST(Network, CountsNodesAndEdgesOfBothKinds) {
  NetworkSource source = twoTiles();
  source.edges = [](const auto& take) { take(std::vector<NetworkEdge>{{0, 127, 1, 1}}); };
  const Network network = buildNetwork(source);
  EXPECT_EQ(network.tileCount(), 2u);
  EXPECT_EQ(network.nodeCount(), 128u);
  EXPECT_EQ(network.edgeCount(), 2u * 144 + 16 + 1);
}

TEST(Network, WithoutALatticeOnlyListedEdgesCount) {
  const Network network = buildNetwork(test::randomInstance({.nodes = 90, .edges = 30}, 7).source());
  EXPECT_EQ(network.nodeCount(), 90u);
  EXPECT_EQ(network.edgeCount(), 30u);
}

TEST(Network, StartsWithItsTerminalsAsExcesses) {
  const Network network =
      buildNetwork(graphSource({5, -(std::int64_t{1} << 50), 0}, std::vector<NetworkEdge>{}));
  EXPECT_EQ(network.excess(0), 5);
  EXPECT_EQ(network.excess(1), -(std::int64_t{1} << 50));
  EXPECT_EQ(network.excess(2), 0);
}

TEST(Network, IsTheSameFromBatchesOfAnySize) {
  const test::Instance instance = test::randomInstance({.nodes = 9, .edges = 30}, 7);
  Network whole = buildNetwork(instance.source());
  Network one_by_one = buildNetwork(graphSource(instance.terminals, EdgeBatches([&](const auto& take) {
                                                  for (const NetworkEdge& edge : instance.edges)
                                                    take(std::span(&edge, 1));
                                                })));
  const MinCut cut = solve(whole);
  EXPECT_EQ(cut.source, solve(one_by_one).source);
  EXPECT_TRUE(verify(instance.source(), one_by_one, cut).certified());
}

TEST(Network, ACopyHasAFlowOfItsOwn) {
  const test::GridInstance instance = test::gridInstance(test::Family::Carving, 8, 1);
  const Network before = buildNetwork(instance.source());
  Network copy = before;
  const MinCut cut = solve(copy);
  EXPECT_FALSE(verify(instance.source(), before, cut).certified());
  EXPECT_TRUE(verify(instance.source(), copy, cut).certified());
}

TEST(Network, TakesAsManyBytesASlotAsItsHeaderSays) {
  const Network network = buildNetwork(test::gridInstance(test::Family::Carving, 32, 1).source());
  EXPECT_LE(static_cast<double>(network.bytes()) / static_cast<double>(network.nodeCount()), 34.5);
}

TEST(Network, RefusesAnEdgeToANodeThatIsNotThere) {
  EXPECT_EQ(refusal({{0, 1, 1, 1}, {1, 3, 1, 1}}),
            "edges: edge 1 joins nodes 1 and 3, but there is no node 3");
}

TEST(Network, RefusesANegativeCapacity) {
  EXPECT_EQ(refusal({{0, 1, 1, -4}}), "edges: edge 0 has the negative capacity -4");
  NetworkSource source = twoTiles();
  source.capacities = [](std::uint32_t tile, TileCapacities& values) {
    values.backward[1][60] = tile == 0 ? -4 : 0;  // towards +y, across
    values.backward[0][63] = -5;                  // no edge there
  };
  EXPECT_EQ(refusal([&] { buildNetwork(source); }), "tiles: tile 0, slot 60 has the negative capacity -4");
}

TEST(Network, RefusesATerminalThatIsTooLarge) {
  EXPECT_EQ(refusal([] {
              buildNetwork(graphSource({1, kLargestTerminal + 1}, std::vector<NetworkEdge>{}));
            }),
            "tiles: tile 0, slot 1 has the terminal 72057594037927937, beyond 2^56");
}

TEST(Network, RefusesAnEdgeFromANodeToItself) {
  EXPECT_EQ(refusal({{2, 2, 1, 1}}), "edges: edge 0 joins node 2 to itself");
}

TEST(Network, RefusesNeighboursThatDoNotFit) {
  NetworkSource source = twoTiles();
  source.tiles[1].neighbours[2] = kNoTile;
  EXPECT_EQ(refusal([&] { buildNetwork(source); }),
            "tiles: tile 0 has the neighbour 1, whose neighbour it is not");
  source.tiles[0].neighbours[3] = 2;
  EXPECT_EQ(refusal([&] { buildNetwork(source); }), "tiles: tile 0 has the neighbour 2, which is not there");
}

TEST(Network, RefusesEdgesThatDifferBetweenTheCalls) {
  const std::vector<NetworkEdge> edges = {{0, 1, 1, 1}, {1, 2, 1, 1}, {0, 2, 1, 1}};
  const std::vector<std::vector<NetworkEdge>> others = {{edges[0], edges[1]},
                                                        {edges[0], edges[1], edges[2], edges[2]},
                                                        {edges[0], edges[1], edges[1]},
                                                        {edges[0], edges[0], edges[0]}};
  for (const std::vector<NetworkEdge>& other : others) {
    for (const int when : {1, 2}) {
      int calls = 0;
      const auto message = refusal([&] {
        buildNetwork(graphSource(std::vector<std::int64_t>(3), EdgeBatches([&](const auto& take) {
                                   take(calls++ == when ? other : edges);
                                 })));
      });
      EXPECT_THAT(message, HasSubstr("not the edges that were handed over the time before"));
    }
  }
}

}  // namespace
}  // namespace vdbfuse
