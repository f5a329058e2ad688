// SPDX-License-Identifier: Apache-2.0
#include "mincut/oracles.h"

#include <algorithm>
#include <boost/graph/boykov_kolmogorov_max_flow.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/push_relabel_max_flow.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#include <limits>

namespace vdbfuse::test {
namespace {

std::int64_t capacityOf(const Instance& instance, std::uint32_t source_set) {
  const auto isSource = [&](std::uint32_t node) { return (source_set >> node & 1) != 0; };
  std::int64_t capacity = 0;
  for (std::uint32_t node = 0; node < instance.terminals.size(); ++node) {
    const std::int64_t terminal = instance.terminals[node];
    capacity += std::max<std::int64_t>(isSource(node) ? -terminal : terminal, 0);
  }
  for (const NetworkEdge& edge : instance.edges) {
    if (isSource(edge.from) && !isSource(edge.to)) capacity += edge.capacity;
    if (isSource(edge.to) && !isSource(edge.from)) capacity += edge.reverse_capacity;
  }
  return capacity;
}

std::vector<CutSide> sidesOf(std::uint32_t source_set, std::size_t nodes) {
  std::vector<CutSide> sides(nodes);
  for (std::size_t node = 0; node < nodes; ++node) {
    sides[node] = (source_set >> node & 1) != 0 ? CutSide::Source : CutSide::Sink;
  }
  return sides;
}

}  // namespace

AllCuts tryAllCuts(const Instance& instance) {
  const std::size_t nodes = instance.terminals.size();
  AllCuts cuts;
  cuts.capacity = std::numeric_limits<std::int64_t>::max();
  std::uint32_t smallest = 0;
  std::uint32_t largest = 0;
  for (std::uint32_t set = 0; set < std::uint32_t{1} << nodes; ++set) {
    const std::int64_t capacity = capacityOf(instance, set);
    if (capacity > cuts.capacity) continue;
    smallest = capacity < cuts.capacity ? set : smallest & set;
    largest = capacity < cuts.capacity ? set : largest | set;
    cuts.capacity = capacity;
  }
  cuts.smallest_source = sidesOf(smallest, nodes);
  cuts.largest_source = sidesOf(largest, nodes);
  return cuts;
}

namespace {

using CsrGraph = boost::compressed_sparse_row_graph<boost::directedS, boost::no_property, boost::no_property,
                                                    boost::no_property, std::uint32_t, std::uint32_t>;

/// One directed edge of Boost's graph and the place of the opposite one in the list.
struct Arc {
  std::uint32_t from, to, opposite;
  std::int64_t capacity;
};

void addPair(std::vector<Arc>& arcs, std::uint32_t from, std::uint32_t to, std::int64_t capacity,
             std::int64_t reverse_capacity) {
  const auto place = static_cast<std::uint32_t>(arcs.size());
  arcs.push_back({from, to, place + 1, capacity});
  arcs.push_back({to, from, place, reverse_capacity});
}

/// All arcs, ordered by their tails as the compressed rows want them.
std::vector<Arc> sortedArcs(const Instance& instance) {
  const auto nodes = static_cast<std::uint32_t>(instance.terminals.size());
  std::vector<Arc> arcs;
  arcs.reserve(2 * (instance.edges.size() + nodes));
  for (const NetworkEdge& e : instance.edges) addPair(arcs, e.from, e.to, e.capacity, e.reverse_capacity);
  for (std::uint32_t node = 0; node < nodes; ++node) {
    const std::int64_t terminal = instance.terminals[node];
    if (terminal > 0) addPair(arcs, nodes, node, terminal, 0);
    if (terminal < 0) addPair(arcs, node, nodes + 1, -terminal, 0);
  }
  std::vector<std::uint32_t> cursor(nodes + 3, 0);
  for (const Arc& arc : arcs) ++cursor[arc.from + 1];
  for (std::uint32_t i = 1; i < cursor.size(); ++i) cursor[i] += cursor[i - 1];
  std::vector<std::uint32_t> place(arcs.size());
  for (std::size_t i = 0; i < arcs.size(); ++i) place[i] = cursor[arcs[i].from]++;
  std::vector<Arc> sorted(arcs.size());
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    sorted[place[i]] = arcs[i];
    sorted[place[i]].opposite = place[arcs[i].opposite];
  }
  return sorted;
}

}  // namespace

struct BoostMaxFlow::Graph {
  CsrGraph rows;
  std::vector<std::int64_t> capacity, residual;
  std::vector<CsrGraph::edge_descriptor> opposite, predecessor;
  std::vector<boost::default_color_type> color;
  std::vector<std::int64_t> distance;
};

BoostMaxFlow::BoostMaxFlow(const Instance& instance) : graph_(std::make_unique<Graph>()) {
  const std::vector<Arc> arcs = sortedArcs(instance);
  const std::size_t nodes = instance.terminals.size() + 2;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
  ends.reserve(arcs.size());
  for (const Arc& arc : arcs) ends.emplace_back(arc.from, arc.to);
  graph_->rows =
      CsrGraph(boost::edges_are_sorted, ends.begin(), ends.end(), static_cast<std::uint32_t>(nodes));
  for (const Arc& arc : arcs) {
    graph_->capacity.push_back(arc.capacity);
    graph_->opposite.emplace_back(arc.to, arc.opposite);
  }
  graph_->residual.resize(arcs.size());
  graph_->predecessor.resize(nodes);
  graph_->color.resize(nodes);
  graph_->distance.resize(nodes);
}

BoostMaxFlow::~BoostMaxFlow() = default;

std::int64_t BoostMaxFlow::solve(Algorithm algorithm) {
  Graph& g = *graph_;
  const auto arc_index = get(boost::edge_index, g.rows);
  const auto node_index = get(boost::vertex_index, g.rows);
  const auto nodes = static_cast<std::uint32_t>(g.color.size());
  const auto capacity = boost::make_iterator_property_map(g.capacity.begin(), arc_index);
  const auto residual = boost::make_iterator_property_map(g.residual.begin(), arc_index);
  const auto opposite = boost::make_iterator_property_map(g.opposite.begin(), arc_index);
  if (algorithm == Algorithm::PushRelabel) {
    return boost::push_relabel_max_flow(g.rows, nodes - 2, nodes - 1, capacity, residual, opposite,
                                        node_index);
  }
  return boost::boykov_kolmogorov_max_flow(
      g.rows, capacity, residual, opposite,
      boost::make_iterator_property_map(g.predecessor.begin(), node_index),
      boost::make_iterator_property_map(g.color.begin(), node_index),
      boost::make_iterator_property_map(g.distance.begin(), node_index), node_index, nodes - 2, nodes - 1);
}

}  // namespace vdbfuse::test
