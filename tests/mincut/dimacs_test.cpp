// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/mincut/dimacs.h"

#include <gtest/gtest.h>

#include <sstream>

#include "mincut/instances.h"
#include "mincut/oracles.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/mincut/solve.h"

namespace vdbfuse {
namespace {

MaxFlowProblem parse(const std::string& text) {
  std::istringstream input(text);
  return readDimacs(input, "flow.max");
}

std::int64_t maxFlow(const MaxFlowProblem& problem) {
  Network network = buildNetwork(problem.source());
  return solve(network).flow + problem.constant;
}

std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const IoError& error) {
    return error.what();
  }
  return "not refused";
}

// The example of the format's own description: its maximum flow is 15.
constexpr const char* kExample =
    "c a comment\np max 6 8\nn 1 s\nn 6 t\na 1 2 5\na 1 3 15\na 2 4 5\na 2 5 5\na 3 4 5\na 3 5 5\na 4 6 15\n"
    "a 5 6 5\n";

TEST(Dimacs, TheFormatsOwnExampleIsReadAndSolved) {
  const MaxFlowProblem problem = parse(kExample);
  EXPECT_EQ(problem.terminals, (std::vector<std::int64_t>{5, 15, -15, -5}));
  EXPECT_EQ(problem.edges.size(), 4u);
  EXPECT_EQ(maxFlow(problem), 15);
}

TEST(Dimacs, WhatIsWrittenIsReadBack) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const test::Instance instance = test::randomInstance({.nodes = 30, .edges = 70}, seed);
    const MaxFlowProblem problem = {instance.terminals, instance.edges, static_cast<std::int64_t>(seed % 3)};
    std::stringstream text;
    writeDimacs(problem, text);
    const MaxFlowProblem back = readDimacs(text, "flow.max");
    EXPECT_EQ(back.terminals, problem.terminals);
    EXPECT_EQ(back.constant, problem.constant);
    EXPECT_EQ(maxFlow(back), test::BoostMaxFlow(instance).solve() + problem.constant) << seed;
  }
}

TEST(Dimacs, SourceAndSinkMayBeAnyNodesAndFlowPastTheNetworkCounts) {
  // Node 2 is the source, 3 the sink; node 1 is joined with both, node 4 with nothing.
  const MaxFlowProblem problem =
      parse("p max 4 6\nn 3 t\nn 2 s\na 2 1 7\na 1 3 4\na 2 3 10\na 1 2 99\na 3 1 99\na 1 1 5\n");
  EXPECT_EQ(problem.terminals, (std::vector<std::int64_t>{3, 0}));
  EXPECT_EQ(problem.constant, 14);
  EXPECT_EQ(maxFlow(problem), 14);
}

TEST(Dimacs, AnArcAndItsReverseInTheNextLineAreOneEdge) {
  const MaxFlowProblem problem = parse("p max 4 3\nn 1 s\nn 4 t\na 2 3 5\na 3 2 6\na 2 3 7\n");
  ASSERT_EQ(problem.edges.size(), 2u);
  EXPECT_EQ(problem.edges[0].capacity, 5);
  EXPECT_EQ(problem.edges[0].reverse_capacity, 6);
  EXPECT_EQ(problem.edges[1].capacity, 7);
  EXPECT_EQ(problem.edges[1].reverse_capacity, 0);
}

TEST(Dimacs, BadFilesAreRefusedByLine) {
  const std::string start = "p max 4 2\nn 1 s\nn 4 t\n";
  EXPECT_EQ(refusal("x 1 2\n"), "flow.max: line 1: expected a line of kind c, p, n or a, found 'x'");
  EXPECT_EQ(refusal("p min 4 2\n"), "flow.max: line 1: expected the problem kind 'max', found 'min'");
  EXPECT_EQ(refusal("p max 4 2\nn 5 s\n"), "flow.max: line 2: expected node from 1 to 4, found '5'");
  EXPECT_EQ(refusal("p max 4 2\na 1 2 3\n"),
            "flow.max: line 2: expected the source and the sink before the first arc, found 'a'");
  EXPECT_EQ(refusal(start + "n 2 s\n"), "flow.max: line 4: expected one source and one sink, found 's'");
  EXPECT_EQ(refusal(start + "a 2 3 -1\na 2 3 1\n"),
            "flow.max: line 4: expected capacity from 0 to 2147483647, found '-1'");
  EXPECT_EQ(refusal(start + "a 2 3 1.5\na 2 3 1\n"),
            "flow.max: line 4: expected capacity from 0 to 2147483647, found '1.5'");
  EXPECT_EQ(refusal(start + "a 2 3\n"),
            "flow.max: line 4: expected capacity from 0 to 2147483647, found the end of the line");
  EXPECT_EQ(refusal(start + "a 2 3 1 9\n"), "flow.max: line 4: expected the end of the line, found '9'");
  EXPECT_EQ(refusal(start + "a 2 3 1\n"),
            "flow.max: line 4: expected 2 arcs, as the problem line says, found 1");
  EXPECT_EQ(refusal(start + "a 2 3 1\na 2 3 1\na 2 3 1\n"),
            "flow.max: line 6: expected no more than 2 arcs, found 'a'");
  EXPECT_EQ(refusal(""), "flow.max: line 0: expected a problem line 'p max NODES ARCS', found none");
}

}  // namespace
}  // namespace vdbfuse
