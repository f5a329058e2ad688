// SPDX-License-Identifier: Apache-2.0
// The minimum-cut solver on its own, as for segmenting an image volume: a noisy ball in 64³ voxels, smoothed
// by a cut. Prints how many voxels were wrong before and after, and the proof that the cut is minimum.
//   example_04_min_cut_alone
#include <cmath>
#include <cstdio>

#include "vdbfuse/base/random.h"
#include "vdbfuse/mincut/solve.h"
#include "vdbfuse/mincut/verify.h"

namespace {

using namespace vdbfuse;

constexpr std::uint32_t kTiles = 16;  // of 4³ voxels, along each axis

double distanceToBall(std::uint32_t tile, std::uint32_t slot) {
  const double x = 4.0 * (tile % kTiles) + slot % 4 - 31.5;
  const double y = 4.0 * (tile / kTiles % kTiles) + slot / 4 % 4 - 31.5;
  const double z = 4.0 * (tile / kTiles / kTiles) + slot / 16 - 31.5;
  return std::sqrt(x * x + y * y + z * z) - 20.0;
}

/// Which tiles there are and which touch.
std::vector<NetworkTile> makeTiles() {
  std::vector<NetworkTile> tiles(kTiles * kTiles * kTiles);
  for (std::uint32_t tile = 0; tile < tiles.size(); ++tile) {
    tiles[tile].nodes = ~std::uint64_t{0};
    std::uint32_t stride = 1;
    for (std::size_t axis = 0; axis < 3; ++axis, stride *= kTiles) {
      if (tile / stride % kTiles > 0) tiles[tile].neighbours[2 * axis] = tile - stride;
      if (tile / stride % kTiles + 1 < kTiles) tiles[tile].neighbours[2 * axis + 1] = tile + stride;
    }
  }
  return tiles;
}

/// Positive: looks like background (the source's side). The same whenever it is asked for.
std::int64_t noisyData(std::uint32_t tile, std::uint32_t slot) {
  Random random(1, std::uint64_t{tile} * lattice::kSlots + slot);
  return std::llround(100 * ((distanceToBall(tile, slot) > 0 ? 1 : -1) + 1.5 * random.normal()));
}

}  // namespace

int main() {
  NetworkSource source;
  source.tiles = makeTiles();
  source.capacities = [](std::uint32_t tile, TileCapacities& values) {
    for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot)
      values.terminal[slot] = noisyData(tile, slot);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      values.forward[axis].fill(80);  // the price of a face between the two sides
      values.backward[axis].fill(80);
    }
  };

  Network network = buildNetwork(source);
  const MinCut cut = solve(network);
  const CutReport report = verify(source, network, cut);

  std::size_t wrong_before = 0, wrong_after = 0;
  for (std::uint32_t tile = 0; tile < network.tileCount(); ++tile) {
    for (std::uint32_t slot = 0; slot < lattice::kSlots; ++slot) {
      const bool background = distanceToBall(tile, slot) > 0;
      wrong_before += (noisyData(tile, slot) > 0) != background;
      wrong_after += (cut.side(tile * lattice::kSlots + slot) == CutSide::Source) != background;
    }
  }
  std::printf("%zu voxels, wrong before the cut: %.1f %%, after: %.2f %%\n", network.nodeCount(),
              100.0 * static_cast<double>(wrong_before) / static_cast<double>(network.nodeCount()),
              100.0 * static_cast<double>(wrong_after) / static_cast<double>(network.nodeCount()));
  std::printf("flow %lld = capacity of the cut %lld: %s\n", static_cast<long long>(report.flow),
              static_cast<long long>(report.cut_capacity), report.certified() ? "minimum" : "NOT PROVEN");
  return report.certified() && 20 * wrong_after < wrong_before ? 0 : 1;
}
