// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/geometry/image.h"

namespace vdbfuse {

/// Where a sensor looked past everything: invalid pixels that survive a 9×9 opening and are joined to the
/// image's border. Isolated misses are chance, and a dark patch inside an object is missed by every view.
/// `outlier`: ε of each pixel, or empty. Depths that are probably wrong (ε > ¾) do not interrupt a region as
/// long as they are not the greater part of any of its squares: a matcher imagines some before empty space.
/// `missed`: 1 where others measured something on the ray, or empty. Squares with more than a few of those (1
/// in 16 pixels) are holes in the measurements.
Image<std::uint8_t> emptyRegions(const Image<float>& depth, const Image<float>& outlier = {},
                                 const Image<std::uint8_t>& missed = {});

/// Share of the image's border pixels that lie in `mask`.
double borderShare(const Image<std::uint8_t>& mask);

}  // namespace vdbfuse
