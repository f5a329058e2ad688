// SPDX-License-Identifier: Apache-2.0
// Which of several minimum cuts: the side of the nodes that are in neither forest.
#pragma once

#include "state.h"

namespace vdbfuse::mincut {

enum class Side : std::uint8_t { Source, Sink };

/// After maximum flow: puts into the forest of this side all nodes that it can reach (that can reach it). The
/// forests do not meet any more, so that only nodes in neither are concerned.
void exhaust(State& state, Side side);

}  // namespace vdbfuse::mincut
