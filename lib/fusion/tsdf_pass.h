// SPDX-License-Identifier: Apache-2.0
// A view that passes over the leaves of a TSDF volume.
#pragma once

#include "fusion/tsdf_state.h"

namespace vdbfuse {

enum class Direction { In, Out };

/// TsdfVolume::integrate() and remove(). REQUIRES: the input fits.
TsdfReport fuseView(const TsdfInput& input, Direction direction, TsdfVolumeState& state);

/// TsdfVolume::carve(). REQUIRES: the input fits.
TsdfReport carveView(const TsdfInput& input, TsdfVolumeState& state);

}  // namespace vdbfuse
