// SPDX-License-Identifier: Apache-2.0
#include "surface/simple_point.h"

#include <array>
#include <bit>
#include <cstdlib>

namespace vdbfuse {
namespace {

constexpr int kCentre = 13;

// Neighbours within the 3³ block that share a face (at most 1 step) or an edge (at most 2 steps).
using Adjacency = std::array<Neighbourhood, 27>;
constexpr Adjacency adjacency(int steps) {
  const auto apart = [](int a, int b) { return a > b ? a - b : b - a; };
  Adjacency table{};
  for (int p = 0; p < 27; ++p) {
    for (int q = 0; q < 27; ++q) {
      const int x = apart(p / 9, q / 9), y = apart(p / 3 % 3, q / 3 % 3), z = apart(p % 3, q % 3);
      const bool near = x <= 1 && y <= 1 && z <= 1 && p != q && q != kCentre;
      if (near && x + y + z <= steps) table[static_cast<std::size_t>(p)] |= Neighbourhood{1} << q;
    }
  }
  return table;
}
constexpr Adjacency kFace = adjacency(1), kEdge = adjacency(2);

// Whether the voxels next to the middle are all in one component of `set`, and there is one at all.
bool isOneComponent(Neighbourhood set, const Adjacency& adjacent) {
  const Neighbourhood next = set & adjacent[kCentre];
  if (next == 0) return false;
  Neighbourhood reached = next & (~next + 1), front = reached;
  while (front != 0) {
    const int p = std::countr_zero(front);
    front &= front - 1;
    const Neighbourhood more = adjacent[static_cast<std::size_t>(p)] & set & ~reached;
    reached |= more, front |= more;
  }
  return (next & ~reached) == 0;
}

}  // namespace

bool isSimple(Neighbourhood inside) {
  constexpr Neighbourhood kAll = (Neighbourhood{1} << 27) - 1, kOwn = Neighbourhood{1} << kCentre;
  return isOneComponent(inside & ~kOwn, kEdge) && isOneComponent(~inside & kAll & ~kOwn, kFace);
}

}  // namespace vdbfuse
