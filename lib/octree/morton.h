// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace vdbfuse {

/// Appends the code itself and those one step down and up `axis`, as far as they lie in [0, side).
void appendNeighbours(std::uint64_t code, int axis, int side, std::vector<std::uint64_t>& out);

}  // namespace vdbfuse
