// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/octree.h"

namespace vdbfuse {
namespace {

// Spreads 21 bits to every third place.
std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x001f00000000ffffULL;
  v = (v | v << 16) & 0x001f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  v = (v | v << 2) & 0x1249249249249249ULL;
  return v;
}

int gather(std::uint64_t v) {
  v &= 0x1249249249249249ULL;
  v = (v | v >> 2) & 0x10c30c30c30c30c3ULL;
  v = (v | v >> 4) & 0x100f00f00f00f00fULL;
  v = (v | v >> 8) & 0x001f0000ff0000ffULL;
  v = (v | v >> 16) & 0x001f00000000ffffULL;
  v = (v | v >> 32) & 0x1fffffULL;
  return static_cast<int>(v);
}

}  // namespace

std::uint64_t mortonCode(const Index3& position) {
  return spread(static_cast<std::uint64_t>(position.x())) |
         spread(static_cast<std::uint64_t>(position.y())) << 1 |
         spread(static_cast<std::uint64_t>(position.z())) << 2;
}

Index3 mortonPosition(std::uint64_t code) { return {gather(code), gather(code >> 1), gather(code >> 2)}; }

}  // namespace vdbfuse
