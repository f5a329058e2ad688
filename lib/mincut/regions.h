// SPDX-License-Identifier: Apache-2.0
// Parts of a network that can be solved on their own, each on a thread.
#pragma once

#include <cstdint>
#include <vector>

#include "state.h"

namespace vdbfuse::mincut {

/// While it lives, no lattice link leads out of the tiles [first, last): what is beyond looks like the tile
/// without nodes. Touches these tiles only.
class ClosedRegion {
 public:
  ClosedRegion(State& state, std::uint32_t first, std::uint32_t last);
  ~ClosedRegion();
  ClosedRegion(const ClosedRegion&) = delete;
  ClosedRegion& operator=(const ClosedRegion&) = delete;

 private:
  struct Link {
    std::uint32_t tile;
    std::uint32_t direction;
    std::uint32_t next;
  };
  State& state_;
  std::vector<Link> closed_;
};

}  // namespace vdbfuse::mincut
