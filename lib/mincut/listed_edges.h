// SPDX-License-Identifier: Apache-2.0
// Which two arcs a listed edge is: edges have no names, but always come in the same order.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "state.h"

namespace vdbfuse::mincut {

/// Throws InvalidArgument, naming the edge, for an edge that cannot be.
void checkEdge(const NetworkEdge& edge, std::uint64_t index, const State& state);

/// Throws InvalidArgument: the edges are not those of the time before.
[[noreturn]] void refuseOtherEdges();

/// Hands out the arcs of edges that come in order. Rows fill from the back.
class ArcCursor {
 public:
  struct Arcs {
    std::uint32_t arc;   ///< from → to
    std::uint32_t mate;  ///< to → from
  };
  explicit ArcCursor(const State& state);
  /// Throws InvalidArgument when there cannot be such an edge next.
  Arcs next(const NetworkEdge& edge);
  /// Throws InvalidArgument unless all arcs were handed out.
  void finish() const;

 private:
  std::uint32_t take(std::uint32_t node);
  const State& state_;
  std::vector<std::uint32_t> ends_;  ///< by row: one past its last arc that is left
  std::uint64_t edges_ = 0;
};

/// Calls visit(edge, arcs) for all listed edges of the source; throws InvalidArgument if they are not those
/// that the state was built with.
void forEachListedEdge(const State& state, const NetworkSource& source,
                       const std::function<void(const NetworkEdge&, ArcCursor::Arcs)>& visit);

}  // namespace vdbfuse::mincut
