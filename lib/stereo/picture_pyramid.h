// SPDX-License-Identifier: Apache-2.0
// A photograph at full, half, quarter … size, as whole numbers that the sweeps add up without rounding.
#pragma once

#include <cstdint>
#include <vector>

#include "vdbfuse/geometry/image.h"
#include "vdbfuse/geometry/projection.h"
#include "vdbfuse/sensor/photograph.h"

namespace vdbfuse::stereo {

/// Brightness 1 as a whole number: 8-bit pictures keep every step, and three more bits for what lies between.
inline constexpr int kWhite = 2040;

/// One level. Coordinates of half the size: c' = (c + ½)/2 − ½.
struct PictureLevel {
  Pinhole camera;
  Image<std::uint16_t> value;  ///< 0 … kWhite
  /// value at (x, y), (x + 1, y), (x, y + 1) and (x + 1, y + 1) in 16 bits each, the lowest first; the last
  /// column and row repeated: all that bilinear interpolation needs, in one load.
  Image<std::uint64_t> quads;
  Image<std::uint8_t> mask;  ///< non-zero where the pixel may be used; empty: everywhere
};

/// Level 0 is the photograph; each of the following is smoothed (1 3 3 1) and half as large. A pixel of a
/// mask is used where all that it was made of is.
std::vector<PictureLevel> picturePyramid(const Photograph& photograph, int levels);

}  // namespace vdbfuse::stereo
