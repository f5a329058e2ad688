// SPDX-License-Identifier: Apache-2.0
// The outlier probabilities of a view in 16 bits a pixel.
#pragma once

#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// 1 … 65533: log(ε/(1 − ε)) from −16 to 16 in equal steps of 4.9e-4, for pixels with a depth. What counts in
/// the evidence is log ε in front of a measurement and log(1 − ε) at it: equal steps of the log-odds lose at
/// most 2.5e-4 of either, where equal steps of ε would lose 0.3 % of the smallest probability. 0, 65534 and
/// 65535: no depth, Look::Nothing, Outside and Empty.
Image<std::uint16_t> encodePixels(const JudgedView& view);

/// Sets `outlier` and `look`; depths where the code says that there is none become invalid.
/// REQUIRES: codes and depth are of one size.
void decodePixels(const Image<std::uint16_t>& codes, JudgedView& view);

/// 255 × (1 − ε), 0 where there is no depth.
Image<std::uint8_t> reliabilityImage(const JudgedView& view);

}  // namespace vdbfuse
