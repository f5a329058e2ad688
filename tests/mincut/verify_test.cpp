// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/verify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mincut/instances.h"

namespace vdbfuse {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Verify : public testing::Test {
 protected:
  CutReport report() const { return verify(network_, cut_); }

  const Network network_ = test::gridInstance(test::Family::Carving, 16, 1).network();
  MinCut cut_ = solve(network_);
};

TEST_F(Verify, CertifiesASolution) {
  EXPECT_TRUE(report().certified());
  EXPECT_EQ(report().cut_capacity, cut_.flow);
  EXPECT_EQ(report().flow, cut_.flow);
  EXPECT_GT(cut_.flow, 0);
}

TEST_F(Verify, SeesAWrongLabel) {
  const std::uint32_t node = 777;
  cut_.sides[node] = cut_.sides[node] == CutSide::Source ? CutSide::Sink : CutSide::Source;
  EXPECT_THAT(report().problems, ElementsAre(HasSubstr("the cut has a capacity of ")));
  EXPECT_GT(report().cut_capacity, report().flow);
}

TEST_F(Verify, SeesThatAllOnOneSideIsNotMinimum) {
  cut_.sides.assign(cut_.sides.size(), CutSide::Sink);
  EXPECT_FALSE(report().certified());
}

TEST_F(Verify, SeesAWrongFlowValue) {
  ++cut_.flow;
  EXPECT_THAT(report().problems,
              ElementsAre(HasSubstr("the flow is stated as " + std::to_string(cut_.flow))));
}

TEST_F(Verify, SeesAResidualThatWasNotPaidFor) {
  ++cut_.residual[100];
  EXPECT_EQ(report().overfull_edges, 1u);
  EXPECT_EQ(report().unbalanced_nodes, 1u);
  EXPECT_THAT(report().problems[0], HasSubstr("1 edges whose residuals do not add up to their capacities"));
  EXPECT_THAT(report().problems[1], HasSubstr("1 nodes whose excess is not terminal + inflow - outflow"));
}

TEST_F(Verify, SeesFlowThatNodesDoNotKnowOf) {
  const std::uint32_t arc = 100;
  ASSERT_GT(cut_.residual[arc], 0u);
  --cut_.residual[arc];
  ++cut_.residual[network_.mate(arc)];
  EXPECT_EQ(report().overfull_edges, 0u);
  EXPECT_EQ(report().unbalanced_nodes, 2u);
}

TEST_F(Verify, SeesFlowThatDoesNotReachTheSink) {
  MinCut none;
  none.sides.assign(network_.nodeCount(), CutSide::Sink);
  for (std::uint32_t node = 0; node < network_.nodeCount(); ++node)
    none.excess.push_back(network_.terminal(node));
  for (std::uint32_t arc = 0; arc < network_.arcCount(); ++arc)
    none.residual.push_back(network_.capacity(arc));
  const CutReport of_none = verify(network_, none);
  EXPECT_EQ(of_none.flow, 0);
  EXPECT_EQ(of_none.overfull_edges + of_none.unbalanced_nodes, 0u);
  EXPECT_THAT(of_none.problems, ElementsAre(HasSubstr("but the flow is 0")));
}

TEST_F(Verify, SeesAWrongExcess) {
  cut_.excess[5] -= 3;
  EXPECT_THAT(report().problems, ElementsAre(HasSubstr("outflow, the first is 5")));
}

TEST_F(Verify, SeesArraysOfTheWrongLength) {
  cut_.sides.pop_back();
  cut_.excess.clear();
  cut_.residual.push_back(0);
  EXPECT_THAT(report().problems,
              ElementsAre("sides has 4095 values, expected 4096", "excess has 0 values, expected 4096",
                          HasSubstr("residual has ")));
}

}  // namespace
}  // namespace vdbfuse
