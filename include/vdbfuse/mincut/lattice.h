// SPDX-License-Identifier: Apache-2.0
// Tiles of 4³ cells, one machine word a tile: bit x + 4y + 16z stands for the cell (x, y, z). A set of cells
// is a word, and a step of all of them to their neighbours is a shift.
#pragma once

#include <array>
#include <cstdint>

namespace vdbfuse::lattice {

inline constexpr int kSide = 4;
inline constexpr std::uint32_t kSlots = 64;
/// Directions are −x, +x, −y, +y, −z, +z: 0 … 5.
inline constexpr int kDirections = 6;
constexpr int opposite(int direction) { return direction ^ 1; }
constexpr bool isForward(int direction) { return (direction & 1) != 0; }

/// Slots from which a step in this direction leaves the tile.
inline constexpr std::array<std::uint64_t, kDirections> kFace = {0x1111111111111111, 0x8888888888888888,
                                                                 0x000f000f000f000f, 0xf000f000f000f000,
                                                                 0x000000000000ffff, 0xffff000000000000};

/// Distance between the slots of neighbours along the axis of this direction.
constexpr int stride(int direction) { return 1 << (direction & ~1); }

/// Where the cells of the tile step to inside the tile; those on the face drop out.
constexpr std::uint64_t stepInside(std::uint64_t slots, int direction) {
  slots &= ~kFace[direction];
  return isForward(direction) ? slots << stride(direction) : slots >> stride(direction);
}

/// Where the cells on the face step to in the next tile; all others drop out.
constexpr std::uint64_t stepAcross(std::uint64_t slots, int direction) {
  slots &= kFace[direction];
  return isForward(direction) ? slots >> 3 * stride(direction) : slots << 3 * stride(direction);
}

/// Where the cells of a tile, and those of the tile behind it, step to in the tile itself.
constexpr std::uint64_t stepInto(std::uint64_t here, std::uint64_t behind, int direction) {
  return stepInside(here, direction) | stepAcross(behind, direction);
}

namespace detail {
struct Tables {
  std::array<std::array<std::uint8_t, kSlots>, kDirections> neighbour{};
  std::array<std::uint8_t, kSlots> leaving{};
};
constexpr Tables makeTables() {
  Tables tables;
  for (int slot = 0; slot < static_cast<int>(kSlots); ++slot) {
    for (int d = 0; d < kDirections; ++d) {
      const bool leaves = (kFace[d] >> slot & 1) != 0;
      const int step = (leaves ? -3 : 1) * (isForward(d) ? stride(d) : -stride(d));
      tables.neighbour[d][slot] = static_cast<std::uint8_t>(slot + step);
      tables.leaving[slot] = static_cast<std::uint8_t>(tables.leaving[slot] | leaves << d);
    }
  }
  return tables;
}
inline constexpr Tables kTables = makeTables();
}  // namespace detail

/// Slot of a neighbour, in the same tile or in the next one.
constexpr std::uint32_t neighbourSlot(std::uint32_t slot, int direction) {
  return detail::kTables.neighbour[direction][slot];
}
/// Bit d: a step in direction d leaves the tile.
constexpr std::uint32_t leavingDirections(std::uint32_t slot) { return detail::kTables.leaving[slot]; }

}  // namespace vdbfuse::lattice
