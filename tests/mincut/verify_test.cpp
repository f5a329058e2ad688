// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/verify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../lib/mincut/state.h"
#include "mincut/instances.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

class Verify : public testing::Test {
 protected:
  CutReport report() const { return verify(source_, network_, cut_); }
  mincut::State& state() { return network_.state(); }

  const test::GridInstance instance_ = test::gridInstance(test::Family::Carving, 16, 1);
  const NetworkSource source_ = instance_.source();
  Network network_ = buildNetwork(source_);
  MinCut cut_ = solve(network_);
};

TEST_F(Verify, CertifiesASolution) {
  EXPECT_TRUE(report().certified());
  EXPECT_EQ(report().cut_capacity, cut_.flow);
  EXPECT_EQ(report().flow, cut_.flow);
  EXPECT_GT(cut_.flow, 0);
}

TEST_F(Verify, SeesAWrongLabel) {
  cut_.source[12] ^= 1u << 9;
  EXPECT_THAT(report().problems, ElementsAre(HasSubstr("the cut has a capacity of ")));
  EXPECT_GT(report().cut_capacity, report().flow);
}

TEST_F(Verify, SeesThatAllOnOneSideIsNotMinimum) {
  for (std::uint64_t& tile : cut_.source) tile = 0;
  EXPECT_FALSE(report().certified());
}

TEST_F(Verify, SeesAWrongFlowValue) {
  ++cut_.flow;
  EXPECT_THAT(report().problems,
              ElementsAre(HasSubstr("the flow is stated as " + std::to_string(cut_.flow))));
}

TEST_F(Verify, SeesAResidualThatWasNotPaidFor) {
  ++state().residual[mincut::State::latticeArc(21, 1)];
  EXPECT_EQ(report().overfull_edges, 1u);
  EXPECT_EQ(report().unbalanced_nodes, 2u);
  EXPECT_THAT(report().problems[0],
              HasSubstr("1 edges whose residuals do not add up to their capacities, the first at node 21"));
  EXPECT_THAT(report().problems[1], HasSubstr("2 nodes whose excess is not terminal + inflow - outflow"));
}

TEST_F(Verify, SeesFlowThatNodesDoNotKnowOf) {
  ++state().residual[mincut::State::latticeArc(21, 1)];
  --state().residual[mincut::State::latticeArc(22, 0)];
  EXPECT_EQ(report().overfull_edges, 0u);
  EXPECT_EQ(report().unbalanced_nodes, 2u);
}

TEST_F(Verify, SeesFlowThatDoesNotReachTheSink) {
  network_ = buildNetwork(source_);
  cut_.flow = 0;
  for (std::uint64_t& tile : cut_.source) tile = 0;
  EXPECT_EQ(report().flow, 0);
  EXPECT_EQ(report().overfull_edges + report().unbalanced_nodes, 0u);
  EXPECT_THAT(report().problems, ElementsAre(HasSubstr("but the flow is 0")));
}

TEST_F(Verify, SeesAWrongExcess) {
  state().excess[5] -= 3;
  EXPECT_THAT(report().problems, Contains(HasSubstr("outflow, the first is 5")));
}

TEST_F(Verify, SeesOtherCapacitiesThanThoseSolved) {
  test::GridInstance other = instance_;
  other.capacities[1][100] += 7;
  const CutReport of_other = verify(other.source(), network_, cut_);
  EXPECT_EQ(of_other.overfull_edges, 1u);
  EXPECT_FALSE(of_other.certified());
}

TEST_F(Verify, SeesOtherTerminalsThanThoseSolved) {
  test::GridInstance other = instance_;
  ++other.terminals[77];
  EXPECT_EQ(verify(other.source(), network_, cut_).unbalanced_nodes, 1u);
}

TEST_F(Verify, SeesTheSameOfListedEdges) {
  const test::Instance graph = test::randomInstance({.nodes = 9, .edges = 30}, 7);
  Network network = buildNetwork(graph.source());
  const MinCut cut = solve(network);
  EXPECT_TRUE(verify(graph.source(), network, cut).certified());
  ++network.state().arc_residual[4];
  EXPECT_EQ(verify(graph.source(), network, cut).overfull_edges, 1u);
}

TEST_F(Verify, SeesLabelsOfTheWrongLength) {
  cut_.source.pop_back();
  EXPECT_THAT(report().problems, ElementsAre("the cut has labels for 63 tiles, expected 64"));
}

TEST_F(Verify, RefusesASourceOfAnotherNetwork) { EXPECT_THROW(verify({}, network_, cut_), InvalidArgument); }

}  // namespace
}  // namespace vdbfuse
