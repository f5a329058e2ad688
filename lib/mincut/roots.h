// SPDX-License-Identifier: Apache-2.0
// Where the search starts: nodes with an excess or a deficit.
#pragma once

#include <cstdint>

#include "state.h"

namespace vdbfuse::mincut {

/// Tells source and sink nodes of all tiles from their excesses; returns the sum of all excesses, each
/// clamped to ±2³⁰: whether there is more to give or more to take.
std::int64_t markRoots(State& state);

/// Excesses next to deficits need no search to find each other: one sweep in memory order over the tiles
/// [first, last), within them. Keeps the marks right.
void settleNeighbours(State& state, std::uint32_t first, std::uint32_t last);

}  // namespace vdbfuse::mincut
