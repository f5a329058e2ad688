// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/network.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "mincut/instances.h"
#include "vdbfuse/base/errors.h"

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
  return refusal([&] { buildNetwork(std::vector<std::int64_t>(3), edges); });
}

TEST(Network, HoldsEveryEdgeAsTwoMates) {
  const test::Instance instance = test::randomInstance({.nodes = 9, .edges = 30}, 7);
  const Network network = instance.network();
  ASSERT_EQ(network.arcCount(), 60u);
  for (std::uint32_t node = 0; node < network.nodeCount(); ++node) {
    for (std::uint32_t arc = network.firstArc(node); arc < network.firstArc(node + 1); ++arc) {
      EXPECT_NE(network.mate(arc), arc);
      EXPECT_EQ(network.mate(network.mate(arc)), arc);
      EXPECT_EQ(network.head(network.mate(arc)), node);
    }
  }
}

TEST(Network, KeepsBothCapacitiesOfAnEdge) {
  const std::vector<NetworkEdge> edges = {{0, 2, 5, 7}};
  const Network network = buildNetwork(std::vector<std::int64_t>(3), edges);
  const std::uint32_t arc = network.firstArc(0);
  EXPECT_EQ(network.head(arc), 2u);
  EXPECT_EQ(network.capacity(arc), 5);
  EXPECT_EQ(network.capacity(network.mate(arc)), 7);
}

TEST(Network, IsTheSameFromBatchesOfAnySize) {
  const test::Instance instance = test::randomInstance({.nodes = 9, .edges = 30}, 7);
  const Network whole = instance.network();
  const Network one_by_one = buildNetwork(instance.terminals, [&](const auto& take) {
    for (const NetworkEdge& edge : instance.edges) take(std::span(&edge, 1));
  });
  for (std::uint32_t arc = 0; arc < whole.arcCount(); ++arc) {
    EXPECT_EQ(whole.head(arc), one_by_one.head(arc));
    EXPECT_EQ(whole.mate(arc), one_by_one.mate(arc));
    EXPECT_EQ(whole.capacity(arc), one_by_one.capacity(arc));
  }
}

TEST(Network, ClampsTerminalsToTheEdgesPlusOne) {
  const std::vector<NetworkEdge> edges = {{0, 1, 5, 7}, {0, 2, 1, 2}};
  const Network network = buildNetwork({1000, -1000, 1}, edges);
  EXPECT_EQ(network.terminal(0), 7);   // 5 + 1 leave node 0
  EXPECT_EQ(network.terminal(1), -6);  // 5 enter node 1
  EXPECT_EQ(network.terminal(2), 1);
}

TEST(Network, RefusesAnEdgeToANodeThatIsNotThere) {
  EXPECT_EQ(refusal({{0, 1, 1, 1}, {1, 3, 1, 1}}),
            "edges: edge 1 joins nodes 1 and 3, but there are 3 nodes");
}

TEST(Network, RefusesANegativeCapacity) {
  EXPECT_EQ(refusal({{0, 1, 1, -4}}), "edges: edge 0 has the negative capacity -4");
}

TEST(Network, RefusesAnEdgeFromANodeToItself) {
  EXPECT_EQ(refusal({{2, 2, 1, 1}}), "edges: edge 0 joins node 2 to itself");
}

TEST(Network, RefusesEdgesThatDifferBetweenTheTwoCalls) {
  const std::vector<NetworkEdge> edges = {{0, 1, 1, 1}, {1, 2, 1, 1}, {0, 2, 1, 1}};
  const std::vector<std::vector<NetworkEdge>> seconds = {{edges[0], edges[1]},
                                                         {edges[0], edges[1], edges[2], edges[2]},
                                                         {edges[0], edges[1], edges[1]},
                                                         {edges[0], edges[0], edges[0]}};
  for (const std::vector<NetworkEdge>& second : seconds) {
    int calls = 0;
    const auto message = refusal([&] {
      buildNetwork(std::vector<std::int64_t>(3),
                   [&](const auto& take) { take(calls++ == 0 ? edges : second); });
    });
    EXPECT_THAT(message, HasSubstr("the second call handed over other edges than the first"));
  }
}

}  // namespace
}  // namespace vdbfuse
