// SPDX-License-Identifier: Apache-2.0
#include "octree/cell_set.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>

namespace vdbfuse {
namespace {

// Cells of a tile at `position` (in tiles) that lie in a domain of `size` cells.
std::uint64_t insideDomain(const Index3& position, const Index3& size) {
  std::uint64_t cells = ~std::uint64_t{0};
  for (int axis = 0; axis < 3; ++axis) {
    const int left = size[axis] - lattice::kSide * position[axis];
    if (left >= lattice::kSide) continue;
    if (left <= 0) return 0;
    // Without the layers beyond: take the upper faces away, one after the other.
    std::uint64_t layer = lattice::kFace[static_cast<std::size_t>(2 * axis + 1)];
    for (int k = lattice::kSide; k > left; --k, layer = lattice::stepInside(layer, 2 * axis)) cells &= ~layer;
  }
  return cells;
}

// The eighth of a tile, twice as fine, that an octant of the tile above covers: 2³ cells to 2³ parents.
std::uint64_t coarsened(std::uint64_t cells, std::uint64_t octant) {
  const Index3 shift = 2 * mortonPosition(octant);
  std::uint64_t result = 0;
  for (; cells != 0; cells &= cells - 1) {
    const int slot = std::countr_zero(cells);
    const int x = (slot & 3) / 2 + shift.x(), y = (slot >> 2 & 3) / 2 + shift.y(),
              z = (slot >> 4) / 2 + shift.z();
    result |= std::uint64_t{1} << (x + 4 * y + 16 * z);
  }
  return result;
}

std::uint64_t refinedOctant(std::uint64_t cells, std::uint64_t octant) {
  constexpr std::uint64_t kChildren = 0x0000000000330033;  // 2³ cells from slot 0
  const Index3 shift = 2 * mortonPosition(octant);
  std::uint64_t result = 0;
  for (int k = 0; k < 8; ++k) {
    const int x = k & 1, y = k >> 1 & 1, z = k >> 2;
    const int parent = x + shift.x() + 4 * (y + shift.y()) + 16 * (z + shift.z());
    if ((cells >> parent & 1) != 0) result |= kChildren << (2 * x + 8 * y + 32 * z);
  }
  return result;
}

}  // namespace

std::uint32_t slotOf(std::uint64_t code) {
  static const auto kSlotByCode = [] {
    std::array<std::uint8_t, lattice::kSlots> slots{};
    for (std::uint64_t c = 0; c < lattice::kSlots; ++c) {
      const Index3 position = mortonPosition(c);
      slots[c] = static_cast<std::uint8_t>(position.x() + 4 * position.y() + 16 * position.z());
    }
    return slots;
  }();
  return kSlotByCode[code % lattice::kSlots];
}

CellSet cellSet(std::vector<CellWord> words) {
  tbb::parallel_sort(words.begin(), words.end(),
                     [](const CellWord& a, const CellWord& b) { return a.code < b.code; });
  std::size_t count = 0;
  for (const CellWord& word : words) {
    if (word.cells == 0) continue;
    if (count > 0 && words[count - 1].code == word.code) {
      words[count - 1].cells |= word.cells;
    } else {
      words[count++] = word;
    }
  }
  words.resize(count);
  return words;
}

CellSet cellSet(const std::vector<std::uint64_t>& codes) {
  CellSet set;
  for (const std::uint64_t code : codes) {
    if (set.empty() || set.back().code != code >> 6) set.push_back({code >> 6, 0});
    set.back().cells |= std::uint64_t{1} << slotOf(code);
  }
  return set;
}

std::size_t cellCount(const CellSet& set) {
  std::size_t count = 0;
  for (const CellWord& word : set) count += static_cast<std::size_t>(std::popcount(word.cells));
  return count;
}

bool holds(const CellSet& set, std::uint64_t code) {
  const auto found = std::lower_bound(set.begin(), set.end(), code >> 6,
                                      [](const CellWord& word, std::uint64_t c) { return word.code < c; });
  return found != set.end() && found->code == code >> 6 && (found->cells >> slotOf(code) & 1) != 0;
}

CellSet dilated(const CellSet& set, const Index3& size) {
  CellSet result = set;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<CellWord> words;
    words.reserve(result.size() * 2);
    for (const CellWord& word : result) {
      const Index3 position = mortonPosition(word.code);
      std::uint64_t cells = word.cells;
      for (int d = 2 * axis; d < 2 * axis + 2; ++d) {
        cells |= lattice::stepInside(word.cells, d);
        const std::uint64_t across = lattice::stepAcross(word.cells, d);
        if (across == 0) continue;
        Index3 next = position;
        next[axis] += lattice::isForward(d) ? 1 : -1;
        if (next[axis] >= 0 && next[axis] * lattice::kSide < size[axis])
          words.push_back({mortonCode(next), across & insideDomain(next, size)});
      }
      words.push_back({word.code, cells & insideDomain(position, size)});
    }
    result = cellSet(std::move(words));
  }
  return result;
}

CellSet parents(const CellSet& set) {
  CellSet result;
  for (const CellWord& word : set) {
    if (result.empty() || result.back().code != word.code >> 3) result.push_back({word.code >> 3, 0});
    result.back().cells |= coarsened(word.cells, word.code & 7);
  }
  return result;
}

CellSet children(const CellSet& set) {
  CellSet result;
  for (const CellWord& word : set) {
    for (std::uint64_t octant = 0; octant < 8; ++octant) {
      const std::uint64_t cells = refinedOctant(word.cells, octant);
      if (cells != 0) result.push_back({word.code << 3 | octant, cells});
    }
  }
  return result;
}

CellSet united(const CellSet& a, const CellSet& b) {
  std::vector<CellWord> words = a;
  words.insert(words.end(), b.begin(), b.end());
  return cellSet(std::move(words));
}

CellSet without(const CellSet& set, const CellSet& taken) {
  CellSet result;
  auto next = taken.begin();
  for (const CellWord& word : set) {
    while (next != taken.end() && next->code < word.code) ++next;
    const bool met = next != taken.end() && next->code == word.code;
    const std::uint64_t left = met ? word.cells & ~next->cells : word.cells;
    if (left != 0) result.push_back({word.code, left});
  }
  return result;
}

CellSet allCells(const Index3& size) {
  std::vector<CellWord> words;
  for (int x = 0; x * lattice::kSide < size.x(); ++x) {
    for (int y = 0; y * lattice::kSide < size.y(); ++y) {
      for (int z = 0; z * lattice::kSide < size.z(); ++z)
        words.push_back({mortonCode({x, y, z}), insideDomain({x, y, z}, size)});
    }
  }
  return cellSet(std::move(words));
}

}  // namespace vdbfuse
