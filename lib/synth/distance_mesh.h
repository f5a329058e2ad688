// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/synth/scene.h"

namespace vdbfuse::synth {

/// Triangulates {distance = 0} inside `bounds` by dual contouring (Ju, Losasso, Schaefer, Warren, SIGGRAPH
/// 2002) on cubes of edge `cell`, so that sharp edges stay sharp; vertices are then moved onto the surface.
/// REQUIRES: the surface lies inside `bounds`, and has no detail near the size of a cell (else not a
/// manifold).
TriangleMesh meshFromDistance(const SignedDistance& distance, const Box& bounds, double cell);

}  // namespace vdbfuse::synth
