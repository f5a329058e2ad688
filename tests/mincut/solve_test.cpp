// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "mincut/instances.h"
#include "mincut/oracles.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/mincut/verify.h"

namespace vdbfuse {
namespace {

using test::Family;
using test::GridInstance;
using test::Instance;

constexpr auto kPushRelabel = test::BoostMaxFlow::Algorithm::PushRelabel;
constexpr std::int32_t kLargest = std::numeric_limits<std::int32_t>::max();

std::string problems(const CutReport& report) {
  std::string all;
  for (const std::string& problem : report.problems) all += problem + "\n";
  return all;
}

MinCut solveAndCheck(const NetworkSource& source, CutTies ties = CutTies::SmallestSource) {
  Network network = buildNetwork(source);
  MinCut cut = solve(network, {.ties = ties});
  const CutReport report = verify(source, network, cut);
  EXPECT_TRUE(report.certified()) << problems(report);
  return cut;
}

/// Labels and flow; fails the test if the certificate does.
struct Solution {
  std::vector<CutSide> sides;
  std::int64_t flow = 0;
};
Solution solveAndCheck(const Instance& instance, CutTies ties = CutTies::SmallestSource) {
  const MinCut cut = solveAndCheck(instance.source(), ties);
  return {test::sidesOf(cut, instance.terminals.size()), cut.flow};
}
Solution solveAndCheck(const GridInstance& instance, CutTies ties = CutTies::SmallestSource) {
  const MinCut cut = solveAndCheck(instance.source(), ties);
  return {test::sidesOf(cut, instance.terminals.size()), cut.flow};
}

/// A chain of `nodes` nodes; supply at the front, demand at the back.
Instance chain(std::uint32_t nodes, std::int64_t supply, std::int64_t demand, std::int32_t capacity) {
  Instance instance;
  instance.terminals.resize(nodes);
  instance.terminals.front() = supply;
  instance.terminals.back() = -demand;
  for (std::uint32_t node = 1; node < nodes; ++node)
    instance.edges.push_back({node - 1, node, capacity, capacity});
  return instance;
}

std::ptrdiff_t sourceCount(const Solution& cut) { return std::ranges::count(cut.sides, CutSide::Source); }

/// The same network with node v called order[v].
Instance renumbered(const Instance& instance, const std::vector<std::uint32_t>& order) {
  Instance other = instance;
  for (std::size_t node = 0; node < order.size(); ++node)
    other.terminals[order[node]] = instance.terminals[node];
  for (NetworkEdge& edge : other.edges)
    edge = {order[edge.from], order[edge.to], edge.capacity, edge.reverse_capacity};
  std::ranges::reverse(other.edges);
  return other;
}

TEST(Solve, FindsTheCutThatBruteForceFinds) {
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    const test::RandomRange range = {.nodes = static_cast<std::uint32_t>(1 + seed % 11),
                                     .edges = static_cast<std::uint32_t>(seed % 29),
                                     .terminal = seed % 5 == 0 ? 40 : 10,
                                     .capacity = seed % 3 == 0 ? 3 : 10};
    const Instance instance = test::randomInstance(range, seed);
    const test::AllCuts all = test::tryAllCuts(instance);
    const Solution smallest = solveAndCheck(instance, CutTies::SmallestSource);
    const Solution largest = solveAndCheck(instance, CutTies::LargestSource);
    ASSERT_EQ(smallest.flow, all.capacity) << "seed " << seed;
    ASSERT_EQ(smallest.sides, all.smallest_source) << "seed " << seed;
    ASSERT_EQ(largest.sides, all.largest_source) << "seed " << seed;
  }
}

TEST(Solve, FindsTheCutThatBruteForceFindsInLargerGraphs) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const Instance instance =
        test::randomInstance({.nodes = 16, .edges = 40, .terminal = 12, .capacity = 6}, seed);
    const test::AllCuts all = test::tryAllCuts(instance);
    EXPECT_EQ(solveAndCheck(instance, CutTies::SmallestSource).sides, all.smallest_source) << "seed " << seed;
    EXPECT_EQ(solveAndCheck(instance, CutTies::LargestSource).sides, all.largest_source) << "seed " << seed;
  }
}

TEST(Solve, AgreesWithBoostOnRandomGraphs) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const auto nodes = static_cast<std::uint32_t>(2 + 7 * (seed % 40));
    const test::RandomRange range = {.nodes = nodes,
                                     .edges = nodes * static_cast<std::uint32_t>(1 + seed % 5),
                                     .terminal = seed % 2 == 0 ? 30 : 1000,
                                     .capacity = seed % 3 == 0 ? 1000 : 20};
    const Instance instance = test::randomInstance(range, seed);
    const std::int64_t flow = solveAndCheck(instance).flow;
    ASSERT_EQ(flow, test::BoostMaxFlow(instance).solve()) << "seed " << seed;
    ASSERT_EQ(flow, test::BoostMaxFlow(instance).solve(kPushRelabel)) << "seed " << seed;
  }
}

TEST(Solve, AgreesWithBoostOnGridsOfEveryFamily) {
  for (const Family family : test::kFamilies) {
    for (const std::uint32_t side : {16u, 40u}) {
      const GridInstance instance = test::gridInstance(family, side, side);
      const Solution cut = solveAndCheck(instance);
      const Instance graph = instance.graph();
      EXPECT_EQ(cut.flow, test::BoostMaxFlow(graph).solve()) << test::name(family) << " " << side;
      EXPECT_EQ(cut.flow, test::BoostMaxFlow(graph).solve(kPushRelabel)) << test::name(family) << " " << side;
    }
  }
}

TEST(Solve, LatticeEdgesAndListedOnesGiveTheSameCut) {
  for (const Family family : test::kFamilies) {
    const GridInstance instance = test::gridInstance(family, 24, 5);
    for (const CutTies ties : {CutTies::SmallestSource, CutTies::LargestSource}) {
      const Solution lattice = solveAndCheck(instance, ties), graph = solveAndCheck(instance.graph(), ties);
      EXPECT_EQ(lattice.flow, graph.flow) << test::name(family);
      EXPECT_EQ(lattice.sides, graph.sides) << test::name(family);
    }
  }
}

TEST(Solve, TilesWithHolesAndMixedEdgesAreSolvedToo) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const test::MixedInstance instance = test::mixedInstance(seed);
    const MinCut cut = solveAndCheck(instance.source());
    const Instance graph = instance.graph();
    EXPECT_EQ(cut.flow, test::BoostMaxFlow(graph).solve()) << "seed " << seed;
    EXPECT_EQ(test::sidesOf(cut, graph.terminals.size()), solveAndCheck(graph).sides) << "seed " << seed;
  }
}

TEST(Solve, GivesTheSameLabelsForAnyNumberOfThreads) {
  for (const Family family : {Family::LowContrast, Family::OneSidedScan}) {
    const GridInstance instance = test::gridInstance(family, 96, 6);  // more than one region
    const auto run = [&](int threads) {
      const ThreadLimit limit(threads);
      const MinCut cut = solveAndCheck(instance.source());
      EXPECT_EQ(cut.statistics.regions, threads > 1 ? 4u : 0u);
      return cut.source;
    };
    const auto one = run(1);
    EXPECT_EQ(one, run(2));
    EXPECT_EQ(one, run(5));
    EXPECT_EQ(test::sidesOf(solveAndCheck(instance.source()), 1000), [&] {
      auto s = solveAndCheck(instance.graph()).sides;
      s.resize(1000);
      return s;
    }());
  }
}

TEST(Solve, AgreesWithBoostOnALargeGrid) {
  const GridInstance instance = test::gridInstance(Family::Carving, 128, 1);
  const Solution cut = solveAndCheck(instance);
  EXPECT_EQ(cut.flow, test::BoostMaxFlow(instance.graph()).solve());
  EXPECT_GT(sourceCount(cut), 128 * 128 * 128 / 2);
  EXPECT_LT(sourceCount(cut), 128 * 128 * 128);
}

TEST(Solve, CertifiesEveryFamilyOnALargeGrid) {
  for (const Family family : test::kFamilies) {
    SCOPED_TRACE(test::name(family));
    solveAndCheck(test::gridInstance(family, 96, 2));
  }
}

TEST(Solve, BothTiesHaveTheSameFlowAndNestedSides) {
  for (const Family family : test::kFamilies) {
    const GridInstance instance = test::gridInstance(family, 32, 3);
    const Solution smallest = solveAndCheck(instance, CutTies::SmallestSource);
    const Solution largest = solveAndCheck(instance, CutTies::LargestSource);
    EXPECT_EQ(smallest.flow, largest.flow);
    for (std::size_t node = 0; node < smallest.sides.size(); ++node) {
      EXPECT_LE(smallest.sides[node], largest.sides[node]) << test::name(family) << " node " << node;
    }
  }
}

TEST(Solve, LabelsDoNotDependOnTheOrderOfNodesAndEdges) {
  const Instance instance = test::gridInstance(Family::LowContrast, 24, 4).graph();
  std::vector<std::uint32_t> order(instance.terminals.size());
  std::iota(order.begin(), order.end(), 0u);
  Random random(5);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  const Solution cut = solveAndCheck(instance);
  const Solution other = solveAndCheck(renumbered(instance, order));
  for (std::size_t node = 0; node < order.size(); ++node)
    ASSERT_EQ(cut.sides[node], other.sides[order[node]]);
}

TEST(Solve, AnEmptyNetworkHasAnEmptyCut) {
  const Solution cut = solveAndCheck(Instance());
  EXPECT_EQ(cut.flow, 0);
  EXPECT_TRUE(cut.sides.empty());
  Network empty;
  EXPECT_EQ(solve(empty).flow, 0);
}

TEST(Solve, NodesWithoutEdgesGoWhereTheirTerminalSays) {
  const Instance instance = {.terminals = {5, -5, 0}, .edges = {}};
  using enum CutSide;
  EXPECT_EQ(solveAndCheck(instance, CutTies::SmallestSource).sides,
            (std::vector<CutSide>{Source, Sink, Sink}));
  EXPECT_EQ(solveAndCheck(instance, CutTies::LargestSource).sides,
            (std::vector<CutSide>{Source, Sink, Source}));
}

TEST(Solve, WithSupplyOnlyNothingIsCut) {
  GridInstance instance = test::gridInstance(Family::Carving, 16, 1);
  for (std::int64_t& terminal : instance.terminals) terminal = std::abs(terminal) + 1;
  const Solution cut = solveAndCheck(instance);
  EXPECT_EQ(cut.flow, 0);
  EXPECT_EQ(sourceCount(cut), std::ssize(instance.terminals));
}

TEST(Solve, WithDemandOnlyNothingIsCut) {
  GridInstance instance = test::gridInstance(Family::Carving, 16, 1);
  for (std::int64_t& terminal : instance.terminals) terminal = -std::abs(terminal) - 1;
  const Solution cut = solveAndCheck(instance);
  EXPECT_EQ(cut.flow, 0);
  EXPECT_EQ(sourceCount(cut), 0);
}

TEST(Solve, EdgesOfNoCapacitySeparate) {
  GridInstance instance = test::gridInstance(Family::DenseNoisy, 16, 1);
  for (auto& capacities : instance.capacities) std::ranges::fill(capacities, 0);
  const Solution cut = solveAndCheck(instance);
  EXPECT_EQ(cut.flow, 0);
  for (std::size_t node = 0; node < cut.sides.size(); ++node) {
    EXPECT_EQ(cut.sides[node] == CutSide::Source, instance.terminals[node] > 0);
  }
}

TEST(Solve, PartsThatAreNotConnectedAreCutOnTheirOwn) {
  const Instance part = test::gridInstance(Family::DenseNoisy, 16, 1).graph();
  const auto nodes = static_cast<std::uint32_t>(part.terminals.size());
  Instance both = part;
  both.terminals.insert(both.terminals.end(), part.terminals.begin(), part.terminals.end());
  for (const NetworkEdge& e : part.edges) {
    both.edges.push_back({e.from + nodes, e.to + nodes, e.capacity, e.reverse_capacity});
  }
  const Solution one = solveAndCheck(part);
  const Solution two = solveAndCheck(both);
  EXPECT_EQ(two.flow, 2 * one.flow);
  EXPECT_TRUE(std::equal(one.sides.begin(), one.sides.end(), two.sides.begin() + nodes));
}

TEST(Solve, AFlowBeyond32BitsIsExact) {
  Instance instance;
  constexpr std::uint32_t kPaths = 1000;
  instance.terminals.resize(2 * kPaths, -std::int64_t{1} << 40);
  for (std::uint32_t path = 0; path < kPaths; ++path) {
    instance.terminals[path] = std::int64_t{1} << 40;
    instance.edges.push_back({path, path + kPaths, kLargest, kLargest});
  }
  EXPECT_EQ(solveAndCheck(instance).flow, std::int64_t{kPaths} * kLargest);
}

TEST(Solve, CapacitiesMayBeTheLargestInteger) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Instance instance = test::randomInstance(
        {.nodes = 30, .edges = 90, .terminal = std::int64_t{4} * kLargest, .capacity = kLargest}, seed);
    ASSERT_EQ(solveAndCheck(instance).flow, test::BoostMaxFlow(instance).solve()) << "seed " << seed;
  }
}

TEST(Solve, WideEdgesBetweenSmallTerminalsDoNotMakeItRunForever) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Instance instance =
        test::randomInstance({.nodes = 40, .edges = 120, .terminal = 3, .capacity = kLargest}, seed);
    ASSERT_EQ(solveAndCheck(instance).flow, test::BoostMaxFlow(instance).solve()) << "seed " << seed;
  }
}

TEST(Solve, ALongChainIsCutAtItsNarrowestEdge) {
  Instance instance = chain(100000, 1000, 1000, 50);
  instance.edges[70000].capacity = 7;
  const Solution cut = solveAndCheck(instance);
  EXPECT_EQ(cut.flow, 7);
  EXPECT_EQ(sourceCount(cut), 70001);
}

TEST(Solve, AlongAnEvenChainTheTiesAreTheEnds) {
  const Instance instance = chain(100000, 1000, 1000, 50);
  EXPECT_EQ(sourceCount(solveAndCheck(instance, CutTies::SmallestSource)), 1);
  EXPECT_EQ(sourceCount(solveAndCheck(instance, CutTies::LargestSource)), 99999);
}

TEST(Solve, ALongChainOfSmallDemandsIsFilledFromOneEnd) {
  constexpr std::uint32_t kNodes = 20000;
  Instance instance = chain(kNodes, 1000000, 1, 1000000);
  for (std::uint32_t node = 1; node < kNodes; ++node) instance.terminals[node] = -1;
  EXPECT_EQ(solveAndCheck(instance).flow, kNodes - 1);
  for (std::int64_t& terminal : instance.terminals) terminal = -terminal;
  EXPECT_EQ(solveAndCheck(instance).flow, kNodes - 1);
}

TEST(Solve, AStarWithManyArmsIsSolved) {
  Instance instance;
  constexpr std::uint32_t kArms = 20000;
  instance.terminals.resize(2 * kArms + 1);
  for (std::uint32_t arm = 1; arm <= 2 * kArms; ++arm) {
    instance.terminals[arm] = arm % 2 == 0 ? 5 : -5;
    instance.edges.push_back({0, arm, 3, 3});
  }
  EXPECT_EQ(solveAndCheck(instance).flow, 3 * kArms);
}

TEST(Solve, StopsWhenAskedTo) {
  const GridInstance instance = test::gridInstance(Family::Seeds, 48, 1);
  Network network = buildNetwork(instance.source());
  int reports = 0;
  const Progress stop_at_third([&](std::string_view, double) { return ++reports < 3; });
  EXPECT_THROW(solve(network, {}, stop_at_third), Cancelled);
  EXPECT_EQ(reports, 3);
}

TEST(Solve, GoesOnFromWhereItWasStopped) {
  const GridInstance instance = test::gridInstance(Family::LowContrast, 32, 1);
  const NetworkSource source = instance.source();
  Network network = buildNetwork(source);
  int reports = 0;
  EXPECT_THROW(solve(network, {}, Progress([&](std::string_view, double) { return ++reports < 12; })),
               Cancelled);
  const MinCut cut = solve(network);
  EXPECT_TRUE(verify(source, network, cut).certified());
  EXPECT_EQ(test::sidesOf(cut, instance.terminals.size()), solveAndCheck(instance).sides);
}

TEST(Solve, ReportsSharesBetweenZeroAndOne) {
  const GridInstance instance = test::gridInstance(Family::Seeds, 48, 1);
  Network network = buildNetwork(instance.source());
  std::vector<double> shares;
  solve(network, {}, Progress([&](std::string_view, double share) { return shares.push_back(share), true; }));
  EXPECT_GE(shares.size(), 3u);
  EXPECT_EQ(shares.front(), 0.0);
  EXPECT_EQ(shares.back(), 1.0);
  for (const double share : shares) EXPECT_TRUE(share >= 0.0 && share <= 1.0) << share;
}

}  // namespace
}  // namespace vdbfuse
