// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// How the pixels of a block become one.
enum class Reduction {
  Median,  ///< the middle one of the measured depths; nothing when less than half of the block is measured
  Pick,    ///< the pixel in the middle of the block
};

/// The view with images `factor` times smaller. Depth and confidence of a new pixel are those of one and the
/// same old pixel: nothing is averaged across an edge. The mask is that pixel's. Colour stays as it is.
/// REQUIRES: factor ≥ 1; no alternative depths.
View reduced(View view, int factor, Reduction reduction = Reduction::Median);

}  // namespace vdbfuse
