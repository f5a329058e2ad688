// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vdbfuse/base/parallel.h"

namespace vdbfuse {

/// Calls `body(y)` for the rows 0 ≤ y < height of an image, `grain` of them one after the other on one
/// thread (parallelFor()). REQUIRES: height ≥ 0, grain > 0.
template <class Body>
void forEachRow(int height, std::size_t grain, const Body& body) {
  parallelFor(static_cast<std::size_t>(height), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
  });
}

}  // namespace vdbfuse
