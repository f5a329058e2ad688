// SPDX-License-Identifier: Apache-2.0
#include "mincut/instances.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vdbfuse/base/random.h"

namespace vdbfuse::test {
namespace {

constexpr std::int32_t kScale = 4096;  // capacity of an edge at rho = 1
constexpr std::uint32_t kTile = 8;

using Cell = std::array<std::uint32_t, 3>;

struct Grid {
  std::uint32_t side;

  std::uint32_t node(const Cell& c) const {
    const std::uint32_t tiles = side / kTile;
    const std::uint32_t tile = ((c[2] / kTile) * tiles + c[1] / kTile) * tiles + c[0] / kTile;
    return tile * kTile * kTile * kTile + ((c[2] % kTile) * kTile + c[1] % kTile) * kTile + c[0] % kTile;
  }
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

double oneSided(const Grid& grid, const Cell& cell, double distance, Random& random) {
  if (inShadow(grid, cell, distance)) return -0.08 * random.uniform() * 128.0 / grid.side;
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
      return oneSided(grid, cell, distance, random);
    case Family::OneSidedGap:
      return -oneSided(grid, cell, distance, random);
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

void addCell(Family family, const Grid& grid, const Cell& cell, Random& random, Instance& instance) {
  const std::uint32_t node = grid.node(cell);
  instance.terminals[node] = std::lround(kScale * terminalValue(family, grid, cell, random));
  for (int axis = 0; axis < 3; ++axis) {
    if (cell[axis] + 1 == grid.side) continue;
    Cell next = cell;
    ++next[axis];
    Cell middle2 = {2 * cell[0] + 1, 2 * cell[1] + 1, 2 * cell[2] + 1};
    ++middle2[axis];
    const std::int32_t capacity = scaled(edgeValue(family, grid, middle2, random));
    instance.edges.push_back({node, grid.node(next), capacity, capacity});
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
  }
  return "";
}

Instance gridInstance(Family family, std::uint32_t side, std::uint64_t seed) {
  const Grid grid{side};
  Instance instance;
  instance.terminals.resize(std::size_t{side} * side * side);
  instance.edges.reserve(3 * instance.terminals.size());
  Random random(seed, static_cast<std::uint64_t>(family));
  for (std::uint32_t z = 0; z < side; ++z) {
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t x = 0; x < side; ++x) addCell(family, grid, {x, y, z}, random, instance);
    }
  }
  return instance;
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
