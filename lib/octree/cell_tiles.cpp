// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/cell_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>

#include "octree/cell_set.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

constexpr std::size_t kTilesPerTask = 512;

/// The tiles of one level: Morton codes of their lowest voxels in units of the tile, in increasing order.
struct Level {
  std::vector<std::uint64_t> codes;
  std::vector<std::uint32_t> tiles;

  std::optional<std::uint32_t> find(std::uint64_t code) const {
    const auto found = std::lower_bound(codes.begin(), codes.end(), code);
    if (found == codes.end() || *found != code) return std::nullopt;
    return tiles[static_cast<std::size_t>(found - codes.begin())];
  }
};

class Tiler {
 public:
  explicit Tiler(const Octree& octree)
      : octree_(octree), levels_(static_cast<std::size_t>(octree.max_level) + 1) {}

  CellTiles run() {
    if (octree_.cellCount() >= kNoCell) throw InvalidArgument("voxel", "the octree has 2^32 cells or more");
    // Cells come in Morton order, hence those of a tile before those of the next one of its level.
    for (std::size_t cell = 0; cell < octree_.cellCount(); ++cell) addCell(cell);
    parallelFor(result_.tiles.size(), kTilesPerTask, [this](std::size_t begin, std::size_t end) {
      for (std::size_t tile = begin; tile < end; ++tile) link(static_cast<std::uint32_t>(tile));
    });
    listTransitions();
    return std::move(result_);
  }

 private:
  void addCell(std::size_t cell) {
    const std::uint8_t l = octree_.levels[cell];
    const std::uint64_t code = octree_.codes[cell] >> 3 * l;
    Level& level = levels_[l];
    if (level.codes.empty() || level.codes.back() != code >> 6) {
      level.codes.push_back(code >> 6);
      level.tiles.push_back(result_.count());
      result_.tiles.emplace_back();
      result_.levels.push_back(l);
      result_.cells.resize(result_.cells.size() + lattice::kSlots, kNoCell);
      tile_codes_.push_back(code >> 6);
    }
    const std::uint32_t tile = level.tiles.back(), slot = slotOf(code);
    result_.tiles[tile].nodes |= std::uint64_t{1} << slot;
    result_.cells[std::size_t{tile} * lattice::kSlots + slot] = static_cast<std::uint32_t>(cell);
  }

  /// Code of the tile one step in this direction; nothing outside of the domain.
  std::optional<std::uint64_t> stepped(std::uint32_t tile, int direction) const {
    Index3 position = mortonPosition(tile_codes_[tile]);
    position[direction / 2] += lattice::isForward(direction) ? 1 : -1;
    const int side = lattice::kSide << result_.levels[tile];
    if (position[direction / 2] < 0 || position[direction / 2] * side >= octree_.size[direction / 2])
      return std::nullopt;
    return mortonCode(position);
  }

  void link(std::uint32_t tile) {
    for (int d = 0; d < lattice::kDirections; ++d) {
      const std::optional<std::uint64_t> code = stepped(tile, d);
      if (!code) continue;
      if (const auto next = levels_[result_.levels[tile]].find(*code))
        result_.tiles[tile].neighbours[static_cast<std::size_t>(d)] = *next;
    }
  }

  void listTransitions() {
    std::vector<std::vector<CellTransition>> parts(chunkCount(result_.tiles.size(), kTilesPerTask));
    parallelFor(result_.tiles.size(), kTilesPerTask, [&](std::size_t begin, std::size_t end) {
      for (auto tile = static_cast<std::uint32_t>(begin); tile < end; ++tile) {
        for (int d = 0; d < lattice::kDirections; ++d) addTransitions(tile, d, parts[begin / kTilesPerTask]);
      }
    });
    std::size_t total = 0;
    for (const auto& part : parts) total += part.size();
    result_.transitions.reserve(total);
    for (const auto& part : parts)
      result_.transitions.insert(result_.transitions.end(), part.begin(), part.end());
  }

  /// To larger neighbours in this direction, which lie in the tile one level up that holds this one, or in
  /// the one beyond.
  void addTransitions(std::uint32_t t, int direction, std::vector<CellTransition>& out) const {
    if (result_.levels[t] == octree_.max_level) return;
    const NetworkTile& tile = result_.tiles[t];
    const int back = lattice::opposite(direction);
    const std::uint64_t inside =
        tile.nodes & ~lattice::stepInside(tile.nodes, back) & ~lattice::kFace[direction];
    if (inside != 0) addTransitions(t, inside, tile_codes_[t], direction, out);
    const std::optional<std::uint64_t> beyond = stepped(t, direction);
    if (!beyond) return;
    const std::uint32_t next = tile.neighbours[static_cast<std::size_t>(direction)];
    std::uint64_t across = tile.nodes & lattice::kFace[direction];
    if (next != kNoTile) across &= ~lattice::stepAcross(result_.tiles[next].nodes, back);
    if (across != 0) addTransitions(t, across, *beyond, direction, out);
  }

  /// From these slots to cells that cover voxels of the tile-sized block `code`.
  void addTransitions(std::uint32_t t, std::uint64_t slots, std::uint64_t code, int direction,
                      std::vector<CellTransition>& out) const {
    const auto coarse_tile = levels_[std::size_t{result_.levels[t]} + 1].find(code >> 3);
    if (!coarse_tile) return;
    for (; slots != 0; slots &= slots - 1) {
      const auto slot = static_cast<std::uint32_t>(std::countr_zero(slots));
      const std::uint32_t neighbour = lattice::neighbourSlot(slot, direction);
      const Index3 octant = mortonPosition(code & 7);
      const auto half = [&](std::uint32_t position, int axis) {
        return position / 2 + 2 * static_cast<std::uint32_t>(octant[axis]);
      };
      const std::uint32_t coarse =
          half(neighbour % 4, 0) + 4 * half(neighbour / 4 % 4, 1) + 16 * half(neighbour / 16, 2);
      if ((result_.tiles[*coarse_tile].nodes >> coarse & 1) == 0) continue;  // finer cells, which list it
      out.push_back({t * lattice::kSlots + slot, *coarse_tile * lattice::kSlots + coarse,
                     static_cast<std::uint8_t>(direction)});
    }
  }

  const Octree& octree_;
  std::vector<Level> levels_;
  std::vector<std::uint64_t> tile_codes_;  ///< in units of the tile
  CellTiles result_;
};

}  // namespace

CellTiles tileCells(const Octree& octree) { return Tiler(octree).run(); }

}  // namespace vdbfuse
