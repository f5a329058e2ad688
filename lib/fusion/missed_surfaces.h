// SPDX-License-Identifier: Apache-2.0
// What a sensor missed is not empty, however large the hole.
#pragma once

#include <vector>

#include "vdbfuse/geometry/box.h"
#include "vdbfuse/geometry/image.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// Pixels without a depth on whose rays `neighbours` measured something reliable (ε < 0.2) inside `domain`:
/// view `index` should have met it, or whatever hides it. What lies beyond may be out of its reach. Every
/// second pixel of each second row of theirs is looked up.
Image<std::uint8_t> missedSurfaces(const std::vector<JudgedView>& views, std::size_t index,
                                   const std::vector<std::size_t>& neighbours, const Box& domain);

}  // namespace vdbfuse
