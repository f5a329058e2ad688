// SPDX-License-Identifier: Apache-2.0
#include "surface/simple_point.h"

#include <array>
#include <bit>

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

// What can be reached from the middle in so many steps within `set`.
Neighbourhood geodesic(Neighbourhood set, const Adjacency& adjacent, int steps) {
  Neighbourhood reached = set & adjacent[kCentre];
  for (int step = 1; step < steps; ++step) {
    Neighbourhood more = reached;
    for (Neighbourhood front = reached; front != 0; front &= front - 1)
      more |= adjacent[static_cast<std::size_t>(std::countr_zero(front))] & set;
    reached = more;
  }
  return reached;
}

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
  const Neighbourhood solid = geodesic(inside & ~kOwn, kEdge, 2);
  const Neighbourhood empty = geodesic(~inside & kAll & ~kOwn, kFace, 3);
  return isOneComponent(solid, kEdge) && isOneComponent(empty, kFace);
}

}  // namespace vdbfuse
