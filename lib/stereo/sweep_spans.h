// SPDX-License-Identifier: Apache-2.0
// Which part of a tile's rows a sweep has to look at: most tiles at the border of an object have few windows.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "stereo/sweep_kernels.h"

namespace vdbfuse::stereo {

/// Pixels begin … end − 1 of a row, whole vectors of kVectorLanes.
struct Span {
  std::size_t begin = 0, end = 0;
  bool isEmpty() const { return begin >= end; }
};

struct SweepSpans {
  std::vector<Span> windows;  ///< of each row without margin: where there are any
  std::vector<Span> pixels;   ///< of each row with margin: those of all windows that it is part of
};

SweepSpans sweepSpans(const SweepTile& tile);

}  // namespace vdbfuse::stereo
