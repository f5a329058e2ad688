// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/divide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "octree/random_octree.h"

namespace vdbfuse {
namespace {

// A block of finest cells only.
Octree block(const Index3& size) {
  Octree octree;
  octree.frame.voxel = 0.5, octree.size = size, octree.max_level = 0;
  std::vector<std::uint64_t> codes;
  for (int x = 0; x < size.x(); ++x)
    for (int y = 0; y < size.y(); ++y)
      for (int z = 0; z < size.z(); ++z) codes.push_back(mortonCode({x, y, z}));
  std::sort(codes.begin(), codes.end());
  octree.codes = codes;
  octree.levels.assign(codes.size(), 0);
  return octree;
}

// A cube of n³ cells without support in surroundings that call for the other label as loudly as they can.
struct Besieged {
  static constexpr int kSide = 12, kLow = 4, kCube = 4;
  Octree octree = block({kSide, kSide, kSide});
  std::vector<float> support, sigma;
  CutOptions options{.mu = 2.0, .lambda = 0.9, .max_evidence = 10.0, .border = Border::Free};

  // Of the cube: `evidence` or stronger. Around it: whatever, mostly against it.
  Besieged(std::uint64_t seed, float evidence, double mostly) {
    Random random(seed);
    for (std::size_t c = 0; c < octree.cellCount(); ++c) {
      if (inCube(c)) {
        support.push_back(0), sigma.push_back(evidence * static_cast<float>(random.uniform(1, 1.3)));
      } else {
        const float sign = random.uniform() < mostly ? -1.0f : 1.0f;
        support.push_back(static_cast<float>(random.uniform(0, 3)));
        sigma.push_back(std::copysign(10.0f, sign * evidence));
      }
    }
  }
  bool inCube(std::size_t c) const {
    const Eigen::Array3i v = octree.lowest(c).array();
    return (v >= kLow).all() && (v < kLow + kCube).all();
  }
  std::size_t turnedCells() const {
    const Labelling cut = cutCells(octree, tileCells(octree), support, sigma, options);
    std::size_t turned = 0;
    for (std::size_t c = 0; c < octree.cellCount(); ++c)
      turned += inCube(c) && (cut.labels[c] == CellLabel::Outside) != (sigma[c] > 0);
    return turned;
  }
  // Side of the cube, length.
  double side() const { return kCube * octree.frame.voxel; }
};

TEST(IsDecided, NothingAroundACubeOfEnoughEvidenceTurnsAnyOfItsCells) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (const float sign : {-1.0f, 1.0f}) {
      const Besieged all(seed, 0, 1);
      // What the argument needs; isDecided() asks for twice as much.
      const float evidence = sign * static_cast<float>(6.01 / (all.options.lambda * all.side()));
      ASSERT_TRUE(isDecided(all.side(), 2 * evidence, 0, {all.options.lambda}));
      for (const double mostly : {0.5, 0.8, 1.0})
        EXPECT_EQ(Besieged(seed, evidence, mostly).turnedCells(), 0u) << seed << " " << evidence;
    }
  }
}

TEST(IsDecided, TheBoundIsTight) {
  Besieged cube(1, 1, 1);
  const auto bound = static_cast<float>(6 / (cube.options.lambda * cube.side()));
  EXPECT_FALSE(isDecided(cube.side(), 1.98f * bound, 0, {cube.options.lambda}));
  for (std::size_t c = 0; c < cube.octree.cellCount(); ++c) {
    cube.support[c] = 0;
    cube.sigma[c] = cube.inCube(c) ? 0.98f * bound : -10.0f;
  }
  EXPECT_EQ(cube.turnedCells(), 64u);
}

TEST(IsDecided, ACellWithSupportIsNot) {
  EXPECT_TRUE(isDecided(2, 10, 0, {2}));
  EXPECT_FALSE(isDecided(2, 10, 0.1f, {2}));
}

// Two cells of eight voxels a side, of which `left` and `right` is known.
struct Pair {
  Octree octree;
  CellTiles tiles;
  std::vector<float> support = {0, 0};
  CellEvidence evidence{2};
  Pair(float left, float right) {
    octree.frame.voxel = 0.25, octree.size = {16, 8, 8}, octree.max_level = 3;
    octree.codes = {0, 512}, octree.levels = {3, 3};
    tiles = tileCells(octree);
    evidence.mean = evidence.weakest = {left, right};
  }
  std::vector<std::size_t> divided(DivideOptions options) const {
    return cellsToDivide(octree, tiles, support, evidence, options);
  }
};

using Cells = std::vector<std::size_t>;

TEST(CellsToDivide, AreThoseOfOppositeEvidenceWhereItMatters) {
  EXPECT_EQ(Pair(1, -1).divided({1.0}), (Cells{0, 1}));
  EXPECT_EQ(Pair(1, 1).divided({1.0}), Cells{});
  EXPECT_EQ(Pair(-2, -1).divided({1.0}), Cells{});
  // λ |σ| side = 0.8, the weaker of the two.
  EXPECT_EQ(Pair(9, -0.4f).divided({1.0}), Cells{});
}

TEST(CellsToDivide, ADecidedCellIsLeftWhole) {
  const Pair pair(9, -1);  // λ |σ| side = 18 on the left
  EXPECT_EQ(pair.divided({1.0}), Cells{1});
  // The cut clamps the evidence, and with 2 the cell is not decided any more.
  EXPECT_EQ(pair.divided({1.0, 2}), (Cells{0, 1}));
}

TEST(CellsToDivide, MeasuredCellsAndFinestOnesAreLeftAlone) {
  Pair pair(1, -1);
  pair.support[0] = 0.5f;
  EXPECT_EQ(pair.divided({1.0}), Cells{});
  Pair finest(1, -1);
  finest.octree.levels = {0, 0};
  EXPECT_EQ(finest.divided({100.0}), Cells{});
}

TEST(CarriedOver, KnowsWhatBothOctreesHave) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Octree from = test::randomOctree(seed, 40, 4).octree;
    Random random(seed, 2);
    const Octree to = refined(from, {random.below(from.cellCount()), random.below(from.cellCount())});
    CellEvidence evidence(from.cellCount());
    for (std::size_t c = 0; c < from.cellCount(); ++c)
      evidence.mean[c] = static_cast<float>(c), evidence.weakest[c] = -static_cast<float>(c);
    const CellEvidence carried = carriedOver(from, evidence, to);
    for (std::size_t c = 0; c < to.cellCount(); ++c) {
      const std::size_t old = *from.find(to.lowest(c));
      if (from.levels[old] == to.levels[c]) {
        EXPECT_EQ(carried.mean[c], evidence.mean[old]);
        EXPECT_EQ(carried.weakest[c], evidence.weakest[old]);
      } else {
        EXPECT_TRUE(std::isnan(carried.mean[c]));
      }
    }
  }
}

}  // namespace
}  // namespace vdbfuse
