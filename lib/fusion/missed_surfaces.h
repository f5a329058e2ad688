// SPDX-License-Identifier: Apache-2.0
// What a sensor missed is not empty, however large the hole.
#pragma once

#include <cstdint>
#include <vector>

#include "fusion/pixel_testimony.h"
#include "vdbfuse/geometry/box.h"
#include "vdbfuse/geometry/image.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Numbers of pixels.
using PixelList = std::vector<std::uint32_t>;

/// Reliable pixels (ε < 0.2) where some neighbour met nothing: among every second pixel of each second row.
PixelList missedPixels(const JudgedView& view, const Image<PixelTestimony>& testimony);

/// Pixels without a depth on whose rays `neighbours` measured such a point inside `domain`: view `index`
/// should have met it, or whatever hides it. What lies beyond may be out of its reach. `missed`: of all
/// views.
Image<std::uint8_t> missedSurfaces(const std::vector<JudgedView>& views, std::size_t index,
                                   const std::vector<std::size_t>& neighbours,
                                   const std::vector<PixelList>& missed, const Box& domain);

}  // namespace vdbfuse
