// SPDX-License-Identifier: Apache-2.0
#include "regions.h"

namespace vdbfuse::mincut {

ClosedRegion::ClosedRegion(State& state, std::uint32_t first, std::uint32_t last) : state_(state) {
  for (std::uint32_t tile = first; tile < last; ++tile) {
    for (std::uint32_t d = 0; d < lattice::kDirections; ++d) {
      std::uint32_t& next = state.tiles[tile].next[d];
      if (next - first < last - first || next == state.tileCount()) continue;
      closed_.push_back({tile, d, next});
      next = state.tileCount();
    }
  }
}

ClosedRegion::~ClosedRegion() {
  for (const Link& link : closed_) state_.tiles[link.tile].next[link.direction] = link.next;
}

}  // namespace vdbfuse::mincut
