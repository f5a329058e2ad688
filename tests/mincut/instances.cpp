// SPDX-License-Identifier: Apache-2.0
#include "mincut/instances.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vdbfuse/base/random.h"

namespace vdbfuse::test {
namespace {

constexpr std::int32_t kScale = 4096;  // capacity of an edge at rho = 1
using Cell = std::array<std::uint32_t, 3>;

struct Grid {
  std::uint32_t side;
};

/// Distance to the bumpy ball in cells of a 128³ grid, positive outside, at half-cell position `p2` / 2.
double signedDistance(const Grid& grid, const Cell& p2) {
  double p[3];
  for (int k = 0; k < 3; ++k) p[k] = p2[k] / (2.0 * grid.side) - 0.5;
  const double radius = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  const double bump = 0.04 * std::sin(19.0 * p[0]) * std::sin(23.0 * p[1]) * std::sin(17.0 * p[2] + 1.0);
  return 128.0 * (radius - 0.3 - bump);
}

/// True where a scanner that looks along +x has the surface between itself and the cell.
bool inShadow(const Grid& grid, const Cell& cell, double distance) {
  if (distance < 0) return true;
  const double y = (cell[1] + 0.5) / grid.side - 0.5;
  const double z = (cell[2] + 0.5) / grid.side - 0.5;
  return cell[0] > grid.side / 2 && y * y + z * z < 0.09;
}

/// `shadow`: evidence in a cell of a 128³ grid that nobody saw.
double oneSided(const Grid& grid, const Cell& cell, double distance, double shadow, Random& random) {
  if (inShadow(grid, cell, distance)) return shadow * 128.0 / grid.side;
  return 0.6 + 0.2 * random.normal();
}

double terminalValue(Family family, const Grid& grid, const Cell& cell, Random& random) {
  const double distance = signedDistance(grid, {2 * cell[0] + 1, 2 * cell[1] + 1, 2 * cell[2] + 1});
  const bool border =
      std::ranges::any_of(cell, [&](std::uint32_t x) { return x == 0 || x + 1 == grid.side; });
  switch (family) {
    case Family::DenseNoisy:
      return 0.5 * std::clamp(distance / 4.0, -1.0, 1.0) + 0.7 * random.normal();
    case Family::Carving:
      if (distance > 1.0) return random.uniform() < 0.8 ? 1.0 + 0.5 * random.normal() : 0.0;
      return distance > -2.0 ? -0.5 * random.uniform() : -0.01;
    case Family::Seeds:
      return border ? 6.0 : (distance < -0.15 * 128.0 ? -6.0 : 0.0);
    case Family::LowContrast:
      return border || random.uniform() < 0.04 ? 60.0 * std::clamp(distance, -1.0, 1.0) : 0.0;
    case Family::OneSidedScan:
      return oneSided(grid, cell, distance, -0.004, random);
    case Family::OneSidedGap:
      return -oneSided(grid, cell, distance, -0.004, random);
    case Family::OneSidedStrong:
      return oneSided(grid, cell, distance, -0.08 * random.uniform(), random);
  }
  return 0.0;
}

double edgeValue(Family family, const Grid& grid, const Cell& middle2, Random& random) {
  const double distance = signedDistance(grid, middle2);
  const double on_surface = std::exp(-0.5 * distance * distance / 2.25);
  if (family == Family::LowContrast) return 0.9 - 0.05 * on_surface + 0.1 * random.uniform();
  const double noise = 0.15 * random.uniform() * (std::abs(distance) < 12.0 ? 1.0 : 0.1);
  return 1.0 - 0.9 * on_surface - noise;
}

std::int32_t scaled(double value) {
  return std::max<std::int32_t>(1, static_cast<std::int32_t>(std::lround(kScale * value)));
}

/// Bits of three numbers below 2¹⁰ interleaved, x lowest.
std::uint32_t morton(const Cell& cell) {
  std::uint32_t code = 0;
  for (std::uint32_t bit = 0; bit < 10; ++bit) {
    for (std::uint32_t k = 0; k < 3; ++k) code |= (cell[k] >> bit & 1) << (3 * bit + k);
  }
  return code;
}

/// Tile numbers by raster position, in Morton order.
std::vector<std::uint32_t> tileNumbers(std::uint32_t per_side) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < per_side * per_side * per_side; ++i)
    order.emplace_back(morton({i % per_side, i / per_side % per_side, i / per_side / per_side}), i);
  std::ranges::sort(order);
  std::vector<std::uint32_t> numbers(order.size());
  for (std::uint32_t number = 0; number < order.size(); ++number) numbers[order[number].second] = number;
  return numbers;
}

void linkTiles(const std::vector<std::uint32_t>& numbers, std::uint32_t per_side, GridInstance& grid) {
  grid.tiles.resize(numbers.size());
  for (std::uint32_t i = 0; i < numbers.size(); ++i) {
    NetworkTile& tile = grid.tiles[numbers[i]];
    tile.nodes = ~std::uint64_t{0};
    std::uint32_t stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis, stride *= per_side) {
      const std::uint32_t position = i / stride % per_side;
      if (position > 0) tile.neighbours[2 * axis] = numbers[i - stride];
      if (position + 1 < per_side) tile.neighbours[2 * axis + 1] = numbers[i + stride];
    }
  }
}

void setCell(Family family, const Grid& grid, const Cell& cell, std::uint32_t node, Random& random,
             GridInstance& instance) {
  instance.terminals[node] = std::lround(kScale * terminalValue(family, grid, cell, random));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (cell[axis] + 1 == grid.side) continue;
    Cell middle2 = {2 * cell[0] + 1, 2 * cell[1] + 1, 2 * cell[2] + 1};
    ++middle2[axis];
    instance.capacities[axis][node] = scaled(edgeValue(family, grid, middle2, random));
  }
}

}  // namespace

std::string name(Family family) {
  switch (family) {
    case Family::DenseNoisy:
      return "DenseNoisy";
    case Family::Carving:
      return "Carving";
    case Family::Seeds:
      return "Seeds";
    case Family::LowContrast:
      return "LowContrast";
    case Family::OneSidedScan:
      return "OneSidedScan";
    case Family::OneSidedGap:
      return "OneSidedGap";
    case Family::OneSidedStrong:
      return "OneSidedStrong";
  }
  return "";
}

GridInstance gridInstance(Family family, std::uint32_t side, std::uint64_t seed) {
  const Grid grid{side};
  const std::uint32_t per_side = side / lattice::kSide;
  const std::vector<std::uint32_t> numbers = tileNumbers(per_side);
  GridInstance instance;
  instance.side = side;
  linkTiles(numbers, per_side, instance);
  instance.terminals.resize(std::size_t{side} * side * side);
  for (auto& capacities : instance.capacities) capacities.resize(instance.terminals.size());
  Random random(seed, static_cast<std::uint64_t>(family));
  for (std::uint32_t z = 0; z < side; ++z) {
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t x = 0; x < side; ++x) {
        const std::uint32_t tile = numbers[(z / 4 * per_side + y / 4) * per_side + x / 4];
        const std::uint32_t node = tile * lattice::kSlots + z % 4 * 16 + y % 4 * 4 + x % 4;
        setCell(family, grid, {x, y, z}, node, random, instance);
      }
    }
  }
  return instance;
}

NetworkSource GridInstance::source() const {
  NetworkSource source;
  source.tiles = tiles;
  source.capacities = [this](std::uint32_t tile, TileCapacities& values) {
    const std::size_t begin = std::size_t{tile} * lattice::kSlots;
    std::copy_n(terminals.begin() + static_cast<std::ptrdiff_t>(begin), lattice::kSlots,
                values.terminal.begin());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::copy_n(capacities[axis].begin() + static_cast<std::ptrdiff_t>(begin), lattice::kSlots,
                  values.forward[axis].begin());
      values.backward[axis] = values.forward[axis];
    }
  };
  return source;
}

Instance listAllEdges(const NetworkSource& source) {
  Instance graph;
  graph.terminals.resize(source.tiles.size() * lattice::kSlots);
  for (std::uint32_t t = 0; t < source.tiles.size(); ++t) {
    const NetworkTile& tile = source.tiles[t];
    TileCapacities values;
    source.capacities(t, values);
    for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {
      if ((tile.nodes >> slot & 1) == 0) continue;
      graph.terminals[t * lattice::kSlots + slot] = values.terminal[slot];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int d = static_cast<int>(2 * axis + 1);
        const bool leaves = (lattice::leavingDirections(slot) >> d & 1) != 0;
        const std::uint32_t next_tile = leaves ? tile.neighbours[2 * axis + 1] : t;
        const std::uint32_t next_slot = lattice::neighbourSlot(slot, d);
        if (next_tile == kNoTile || (source.tiles[next_tile].nodes >> next_slot & 1) == 0) continue;
        graph.edges.push_back({t * lattice::kSlots + slot, next_tile * lattice::kSlots + next_slot,
                               values.forward[axis][slot], values.backward[axis][slot]});
      }
    }
  }
  if (source.edges) {
    source.edges([&](std::span<const NetworkEdge> batch) {
      graph.edges.insert(graph.edges.end(), batch.begin(), batch.end());
    });
  }
  return graph;
}

MixedInstance mixedInstance(std::uint64_t seed) {
  Random random(seed, 17);
  MixedInstance instance;
  const auto count = static_cast<std::uint32_t>(1 + random.below(4));
  for (std::uint32_t t = 0; t < count; ++t) {
    NetworkTile tile{.nodes = random.next() | random.next()};
    const int axis = static_cast<int>(seed % 3);
    if (t > 0) tile.neighbours[static_cast<std::size_t>(2 * axis)] = t - 1;
    if (t + 1 < count) tile.neighbours[static_cast<std::size_t>(2 * axis + 1)] = t + 1;
    instance.tiles.push_back(tile);
    TileCapacities& values = instance.values.emplace_back();
    for (std::size_t slot = 0; slot < lattice::kSlots; ++slot) {
      values.terminal[slot] = random.below(3) == 0 ? static_cast<std::int64_t>(random.below(41)) - 20 : 0;
      for (std::size_t k = 0; k < 3; ++k) {
        values.forward[k][slot] = static_cast<std::int32_t>(random.below(8));
        values.backward[k][slot] = static_cast<std::int32_t>(random.below(8));
      }
    }
  }
  const auto isNode = [&](std::uint32_t node) {
    return (instance.tiles[node / lattice::kSlots].nodes >> node % lattice::kSlots & 1) != 0;
  };
  for (int i = 0; i < 60; ++i) {
    const auto from = static_cast<std::uint32_t>(random.below(count * lattice::kSlots));
    const auto to = static_cast<std::uint32_t>(random.below(count * lattice::kSlots));
    if (from == to || !isNode(from) || !isNode(to)) continue;
    instance.listed.push_back(
        {from, to, static_cast<std::int32_t>(random.below(9)), static_cast<std::int32_t>(random.below(9))});
  }
  return instance;
}

NetworkSource MixedInstance::source() const {
  NetworkSource source;
  source.tiles = tiles;
  source.capacities = [*this](std::uint32_t tile, TileCapacities& filled) { filled = values[tile]; };
  source.edges = [*this](const auto& take) { take(listed); };
  return source;
}

Instance MixedInstance::graph() const {
  Instance graph;
  graph.edges = listed;
  graph.terminals.resize(tiles.size() * lattice::kSlots);
  const auto isNode = [&](std::uint32_t node) {
    return (tiles[node / lattice::kSlots].nodes >> node % lattice::kSlots & 1) != 0;
  };
  for (std::uint32_t node = 0; node < graph.terminals.size(); ++node) {
    if (!isNode(node)) continue;
    const std::uint32_t t = node / lattice::kSlots, slot = node % lattice::kSlots;
    graph.terminals[node] = values[t].terminal[slot];
    for (std::size_t axis = 0; axis < 3; ++axis) {  // by coordinates, not by the tables of the lattice
      std::array<std::uint32_t, 3> cell = {slot % 4, slot / 4 % 4, slot / 16};
      std::uint32_t tile = t;
      if (++cell[axis] == 4) tile = tiles[t].neighbours[2 * axis + 1], cell[axis] = 0;
      const std::uint32_t next = tile * lattice::kSlots + cell[0] + 4 * cell[1] + 16 * cell[2];
      if (tile == kNoTile || !isNode(next)) continue;
      graph.edges.push_back({node, next, values[t].forward[axis][slot], values[t].backward[axis][slot]});
    }
  }
  return graph;
}

std::vector<CutSide> sidesOf(const MinCut& cut, std::size_t nodes) {
  std::vector<CutSide> sides(nodes);
  for (std::uint32_t node = 0; node < nodes; ++node) sides[node] = cut.side(node);
  return sides;
}

Instance randomInstance(const RandomRange& range, std::uint64_t seed) {
  Random random(seed);
  const auto upTo = [&](std::int64_t largest) {
    return static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(largest) + 1));
  };
  Instance instance;
  for (std::uint32_t node = 0; node < range.nodes; ++node) {
    instance.terminals.push_back(random.below(3) == 0 ? 0 : upTo(2 * range.terminal) - range.terminal);
  }
  for (std::uint32_t edge = 0; range.nodes > 1 && edge < range.edges; ++edge) {
    const auto from = static_cast<std::uint32_t>(random.below(range.nodes));
    const auto step = static_cast<std::uint32_t>(1 + random.below(range.nodes - 1));
    instance.edges.push_back({from, (from + step) % range.nodes,
                              static_cast<std::int32_t>(upTo(range.capacity)),
                              static_cast<std::int32_t>(upTo(range.capacity))});
  }
  return instance;
}

}  // namespace vdbfuse::test
