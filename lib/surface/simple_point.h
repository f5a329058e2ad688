// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace vdbfuse {

/// Which of a voxel's 3³ neighbourhood are inside: bit 9 (dx + 1) + 3 (dy + 1) + dz + 1.
using Neighbourhood = std::uint32_t;

inline constexpr Neighbourhood neighbourBit(int dx, int dy, int dz) {
  return Neighbourhood{1} << (9 * (dx + 1) + 3 * (dy + 1) + dz + 1);
}

/// Whether the voxel in the middle can change sides without a change of topology, neither of the solid nor of
/// what surrounds it: a simple point for 18-connected insides and 6-connected outsides (Bertrand and
/// Malandain 1994), which is how extractSurface() joins voxels. Its own side does not matter.
bool isSimple(Neighbourhood inside);

}  // namespace vdbfuse
