// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/octree/graph.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "octree/random_octree.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/parallel.h"

namespace vdbfuse {
namespace {

using test::forEachVoxel;
using test::randomLabels;
using test::randomOctree;
using test::supportAt;

constexpr std::uint64_t kSeeds = 12;

// Unit faces between the voxels of different cells: (lower cell, upper cell, axis) and their number.
std::map<std::tuple<std::size_t, std::size_t, int>, int> facesByBruteForce(const Octree& octree) {
  std::map<std::tuple<std::size_t, std::size_t, int>, int> areas;
  forEachVoxel(octree, [&](const Index3& v) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto here = octree.find(v), there = octree.find(v + Index3(Index3::Unit(axis)));
      if (there && *there != *here) ++areas[{*here, *there, axis}];
    }
  });
  return areas;
}

TEST(CellFaces, AreThoseBetweenTheVoxelsOfDifferentCells) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Octree octree = randomOctree(seed, 24, 3).octree;
    std::map<std::tuple<std::size_t, std::size_t, int>, int> found;
    forEachFace(tileCells(octree), [&](const CellFace& face) {
      EXPECT_LE(octree.levels[face.first], octree.levels[face.second]);
      const std::size_t low = face.direction > 0 ? face.first : face.second,
                        high = face.direction > 0 ? face.second : face.first;
      const bool is_new = found.emplace(std::tuple{low, high, face.axis}, face.area).second;
      EXPECT_TRUE(is_new);
    });
    EXPECT_EQ(found, facesByBruteForce(octree)) << seed;
  }
}

TEST(CellFaces, CoverAllSixSidesOfEveryCellThatDoesNotLieOnTheBorder) {
  const Octree octree = randomOctree(5, 40, 3).octree;
  std::vector<int> area(octree.cellCount(), 0);
  forEachFace(tileCells(octree), [&](const CellFace& face) {
    area[face.first] += static_cast<int>(face.area), area[face.second] += static_cast<int>(face.area);
  });
  std::size_t inner = 0;
  for (std::size_t c = 0; c < octree.cellCount(); ++c) {
    const Index3 low = octree.lowest(c) - octree.origin, high = low.array() + octree.side(c);
    const int border =
        static_cast<int>((low.array() == 0).count() + (high.array() == octree.size.array()).count());
    EXPECT_EQ(area[c], (6 - border) * octree.side(c) * octree.side(c));
    inner += border == 0;
  }
  EXPECT_GT(inner, 0u);
}

// The energy (1) of a labelling, from voxels alone: nothing in common with the code that is tested.
double energyByVoxels(const Octree& octree, const std::vector<CellLabel>& labels,
                      const std::vector<float>& support, const std::vector<float>& sigma,
                      const CutOptions& options) {
  const double h = octree.frame.voxel;
  double energy = 0;
  const auto isInside = [&](std::size_t c) { return labels[c] == CellLabel::Inside; };
  const auto priceOf = [&](double agreement) {
    return std::max(options.least_cost, std::exp(-options.mu * agreement));
  };
  forEachVoxel(octree, [&](const Index3& v) {
    const std::size_t here = *octree.find(v);
    if (isInside(here))
      energy += options.lambda *
                std::clamp<double>(sigma[here], -options.max_evidence, options.max_evidence) * h * h * h;
    for (int n = 0; n < 6; ++n) {
      const auto there = octree.find(v + Index3((n % 2 == 0 ? 1 : -1) * Index3::Unit(n / 2)));
      if (there && n % 2 == 0 && isInside(here) != isInside(*there))
        energy += h * h * priceOf(0.5 * (support[here] + support[*there]));
      const bool differs_from_beyond = options.border == Border::Outside
                                           ? isInside(here)
                                           : options.border == Border::Solid && !isInside(here);
      if (!there && differs_from_beyond) energy += h * h * priceOf(support[here]);
    }
  });
  return energy;
}

// 2 × 1 × 4 cells of 8³ voxels, one of them divided into eight.
struct TinyProblem {
  Octree octree;
  CellTiles tiles;
  std::vector<float> support, sigma;
  CutOptions options;
  explicit TinyProblem(std::uint64_t seed) {
    Random random(seed);
    octree.frame.voxel = random.uniform(0.1, 2);
    octree.size = {16, 8, 32}, octree.max_level = 3;
    for (std::uint64_t z = 0; z < 4; ++z)
      for (std::uint64_t x = 0; x < 2; ++x) {
        const std::uint64_t code = mortonCode({static_cast<int>(8 * x), 0, static_cast<int>(8 * z)});
        const bool divided = x == 0 && z == 1;
        for (std::uint64_t k = 0; k < (divided ? 8u : 1u); ++k)
          cells.emplace_back(code + 64 * k, divided ? 2 : 3);
      }
    std::sort(cells.begin(), cells.end());
    for (const auto& [code, level] : cells) octree.codes.push_back(code), octree.levels.push_back(level);
    tiles = tileCells(octree);
    for (std::size_t c = 0; c < octree.cellCount(); ++c) {
      support.push_back(random.uniform() < 0.5 ? 0.0f : static_cast<float>(random.uniform(0, 2)));
      sigma.push_back(static_cast<float>(random.uniform(-12, 12)));
    }
    options.lambda = random.uniform(0.01, 0.4) / octree.frame.voxel;
    options.least_cost = seed < 3 ? 0.0 : 0.3;
    options.border = std::array{Border::Outside, Border::Solid, Border::Free}[seed % 3];
  }
  std::vector<std::pair<std::uint64_t, std::uint8_t>> cells;

  double energy(const std::vector<CellLabel>& labels) const {
    return energyByVoxels(octree, labels, support, sigma, options);
  }
};

TEST(CutCells, TheEnergyIsTheSmallestOfAllLabellings) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const TinyProblem problem(seed);
    const std::size_t cells = problem.octree.cellCount();
    ASSERT_EQ(cells, 15u);
    // The energy is a quadratic function of the labels: its coefficients from few evaluations.
    std::vector<CellLabel> labels(cells, CellLabel::Outside);
    const auto with = [&](std::size_t a, std::size_t b) {
      std::vector<CellLabel> l = labels;
      l[a] = l[b] = CellLabel::Inside;
      return problem.energy(l);
    };
    const double none = problem.energy(labels);
    std::vector<double> single(cells);
    for (std::size_t a = 0; a < cells; ++a) single[a] = with(a, a) - none;
    std::vector<std::vector<double>> pair(cells, std::vector<double>(cells, 0));
    for (std::size_t a = 0; a < cells; ++a)
      for (std::size_t b = 0; b < a; ++b) pair[a][b] = with(a, b) - none - single[a] - single[b];
    double best = none;
    for (unsigned mask = 1; mask < 1u << cells; ++mask) {
      double energy = none;
      for (std::size_t a = 0; a < cells; ++a) {
        if (!(mask >> a & 1)) continue;
        energy += single[a];
        for (std::size_t b = 0; b < a; ++b) energy += mask >> b & 1 ? pair[a][b] : 0.0;
      }
      best = std::min(best, energy);
    }
    const Labelling cut =
        cutCells(problem.octree, problem.tiles, problem.support, problem.sigma, problem.options);
    EXPECT_TRUE(cut.certified);
    const double found = problem.energy(cut.labels);
    const double unit = std::pow(problem.octree.frame.voxel, 2) / 32768;
    EXPECT_NEAR(found, best, 100 * unit) << seed;
    EXPECT_NEAR(cut.energy.surface + cut.energy.volume, found, 1e-6 * (1 + std::abs(found)));
    EXPECT_EQ(cut.nodes, cells);
  }
}

// A block of matter in the middle of nothing, both cheap to surround.
struct Block {
  Octree octree = randomOctree(1).octree;
  CellTiles tiles = tileCells(octree);
  std::vector<float> support = std::vector<float>(octree.cellCount(), 0.0f);
  std::vector<float> sigma = std::vector<float>(octree.cellCount(), 0.0f);
};

TEST(CutCells, WithoutEvidenceTheBorderDecides) {
  const Block b;
  CutOptions options;
  options.lambda = 1;
  options.border = Border::Outside;
  for (const CellLabel l : cutCells(b.octree, b.tiles, b.support, b.sigma, options).labels)
    EXPECT_EQ(l, CellLabel::Outside);
  options.border = Border::Solid;
  for (const CellLabel l : cutCells(b.octree, b.tiles, b.support, b.sigma, options).labels)
    EXPECT_EQ(l, CellLabel::Inside);
  options.border = Border::Free;  // nothing decides: the smallest solid
  for (const CellLabel l : cutCells(b.octree, b.tiles, b.support, b.sigma, options).labels)
    EXPECT_EQ(l, CellLabel::Outside);
}

TEST(CutCells, EvidenceIsClampedSoThatOnePlaceCannotHoldOutAgainstItsSurroundings) {
  Block b;
  b.sigma[*b.octree.find(b.octree.origin + b.octree.size / 2)] = -1e9f;
  CutOptions options;
  options.lambda = 0.01;  // at most 0.1 against six faces of 1
  const Labelling cut = cutCells(b.octree, b.tiles, b.support, b.sigma, options);
  for (const CellLabel label : cut.labels) EXPECT_EQ(label, CellLabel::Outside);
}

TEST(CutCells, GivesTheSameLabelsForOneAndTwoThreads) {
  const Octree octree = randomOctree(7).octree;
  Random random(7);
  std::vector<float> support, sigma;
  for (std::size_t c = 0; c < octree.cellCount(); ++c)
    support.push_back(static_cast<float>(random.uniform())),
        sigma.push_back(static_cast<float>(random.normal()));
  CutOptions options;
  options.lambda = 0.5;
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    const Labelling cut = cutCells(octree, tileCells(octree), support, sigma, options);
    return std::pair(cut.labels, cut.flow);
  };
  EXPECT_EQ(run(1), run(2));
}

TEST(CutSource, IntegersKeepDensitiesToOnePerCentAtEveryLevel) {
  constexpr double kUnit = 1.0 / 32768;
  std::size_t faces = 0, cells = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Octree octree = randomOctree(seed).octree;
    const CellTiles tiles = tileCells(octree);
    Random random(seed);
    std::vector<float> support, sigma;
    for (std::size_t c = 0; c < octree.cellCount(); ++c)
      support.push_back(static_cast<float>(random.uniform(0.0, 3.0))),
          sigma.push_back(static_cast<float>(random.normal()));
    const CutOptions options{.mu = 2.0, .lambda = 0.6 / octree.frame.voxel, .border = Border::Free};
    const NetworkSource source = cutSource(octree, tiles, support, sigma, options);
    const auto check = [&](std::uint32_t a, std::uint32_t b, double units) {
      const double area = std::pow(4.0, tiles.levels[a / 64]);
      const double agreement = 0.5 * (support[tiles.cells[a]] + support[tiles.cells[b]]);
      EXPECT_NEAR(units * kUnit / area, std::exp(-options.mu * agreement), 0.01 * std::exp(-2.0 * agreement));
      ++faces;
    };
    for (std::uint32_t t = 0; t < tiles.count(); ++t) {
      TileCapacities values;
      source.capacities(t, values);
      for (std::uint32_t slot = 0; slot < 64; ++slot) {
        const std::uint32_t cell = tiles.cells[64 * t + slot];
        if (cell == kNoCell) continue;
        const double density =
            static_cast<double>(values.terminal[slot]) * kUnit / std::pow(8.0, tiles.levels[t]);
        EXPECT_NEAR(density, 0.6 * sigma[cell], std::max(0.01 * std::abs(0.6 * sigma[cell]), 2e-5));
        ++cells;
        if (slot % 4 < 3 && tiles.cells[64 * t + slot + 1] != kNoCell)
          check(64 * t + slot, 64 * t + slot + 1, values.forward[0][slot]);
      }
    }
    source.edges([&](std::span<const NetworkEdge> batch) {
      for (const NetworkEdge& edge : batch) check(edge.from, edge.to, edge.capacity);
    });
  }
  EXPECT_GT(faces, 1000u);
  EXPECT_GT(cells, 1000u);
}

TEST(CutCells, NegativeWeightsAreRefused) {
  const Block b;
  EXPECT_THROW(cutCells(b.octree, b.tiles, b.support, b.sigma, {.mu = -1.0, .lambda = 1.0}), InvalidArgument);
  EXPECT_THROW(cutCells(b.octree, b.tiles, b.support, b.sigma, {.lambda = -1.0}), InvalidArgument);
  for (const double cost : {-0.1, 1.1})
    EXPECT_THROW(cutCells(b.octree, b.tiles, b.support, b.sigma, {.least_cost = cost}), InvalidArgument);
}

// A solid shell around a hollow of the cell in the middle of a uniform grid of 5³ finest cells.
struct Shell {
  Octree octree;
  CellTiles tiles;
  std::vector<CellLabel> labels;
  Shell() {
    octree.frame.voxel = 0.5, octree.size = {8, 8, 8}, octree.max_level = 0;
    for (std::uint64_t code = 0; code < 512; ++code) octree.codes.push_back(code), octree.levels.push_back(0);
    tiles = tileCells(octree);
    labels.assign(512, CellLabel::Outside);
    for (int i = 0; i < 27; ++i) at({2 + i % 3, 2 + i / 3 % 3, 2 + i / 9}) = CellLabel::Inside;
    at(kHollow) = CellLabel::Outside;
  }
  CellLabel& at(const Index3& voxel) { return labels[*octree.find(voxel)]; }
  std::size_t solid() const {
    return static_cast<std::size_t>(std::count(labels.begin(), labels.end(), CellLabel::Inside));
  }
  static inline const Index3 kHollow{3, 3, 3};
};

TEST(FillUnseenCavities, AHollowThatNoSensorIsInIsFilledAndMeasured) {
  Shell shell;
  const CavityReport report =
      fillUnseenCavities(shell.octree, shell.tiles, {{100, 0, 0}}, Border::Outside, shell.labels);
  EXPECT_EQ(report.filled, 1u);
  EXPECT_DOUBLE_EQ(report.volume, 0.125);
  EXPECT_EQ(shell.solid(), 27u);
}

TEST(FillUnseenCavities, AHollowWithASensorInItStays) {
  Shell shell;
  const Eigen::Vector3d sensor = shell.octree.frame.toWorld(Shell::kHollow) + Eigen::Vector3d(0.1, -0.1, 0.2);
  EXPECT_EQ(fillUnseenCavities(shell.octree, shell.tiles, {sensor}, Border::Outside, shell.labels).filled,
            0u);
  EXPECT_EQ(shell.solid(), 26u);
}

TEST(FillUnseenCavities, AHollowThatIsOpenToTheBorderStays) {
  Shell shell;
  shell.at({3, 3, 4}) = CellLabel::Outside;
  EXPECT_EQ(fillUnseenCavities(shell.octree, shell.tiles, {}, Border::Outside, shell.labels).filled, 0u);
}

TEST(FillUnseenCavities, InARoomOnlyWhatASensorSeesIsEmpty) {
  Shell shell;
  const Eigen::Vector3d inside = shell.octree.frame.toWorld(Shell::kHollow);
  const CavityReport report =
      fillUnseenCavities(shell.octree, shell.tiles, {inside}, Border::Solid, shell.labels);
  EXPECT_EQ(report.filled, 1u);
  EXPECT_EQ(shell.solid(), 511u);
  // With no sensor inside the domain nothing can be told from the room outside.
  Shell other;
  EXPECT_EQ(fillUnseenCavities(other.octree, other.tiles, {{100, 0, 0}}, Border::Solid, other.labels).filled,
            1u);
  EXPECT_EQ(other.solid(), 27u);
}

TEST(RemoveSpecks, WhatIsSmallerGoesAndWhatIsNotStays) {
  Shell shell;
  shell.at({6, 6, 6}) = CellLabel::Inside;  // two voxels of 0.125 together
  shell.at({6, 6, 7}) = CellLabel::Inside;
  Shell before = shell;
  const SpeckReport none = removeSpecks(shell.octree, shell.tiles, 0.25, Border::Outside, shell.labels);
  EXPECT_EQ(none.removed, 0u);
  EXPECT_EQ(shell.labels, before.labels);
  const SpeckReport one = removeSpecks(shell.octree, shell.tiles, 0.26, Border::Outside, shell.labels);
  EXPECT_EQ(one.removed, 1u);
  EXPECT_DOUBLE_EQ(one.volume, 0.25);
  EXPECT_EQ(shell.solid(), 26u);
}

TEST(RemoveSpecks, WhatMayGoOnBeyondTheBorderStays) {
  for (const Border border : {Border::Solid, Border::Free}) {
    Shell shell;
    shell.at({6, 6, 7}) = CellLabel::Inside;
    EXPECT_EQ(removeSpecks(shell.octree, shell.tiles, 1, border, shell.labels).removed, 0u);
  }
}

TEST(SampleCells, IsTheMeanOverTheVoxelsOfACellOfWhatReachesTheThreshold) {
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Octree octree = randomOctree(seed, 40, 4).octree;
    // Voxels that the octree did not ask for, in cells of all sizes; one below the threshold.
    Random random(seed, 7);
    std::vector<Index3> voxels;
    for (int i = 0; i < 60; ++i) {
      Index3 v;
      for (int a = 0; a < 3; ++a)
        v[a] = octree.origin[a] + static_cast<int>(random.below(static_cast<std::uint64_t>(octree.size[a])));
      voxels.push_back(v);
    }
    const ScalarGrid grid = supportAt(voxels, octree.frame);
    const Index3 low = voxels.front() - leafOrigin(voxels.front());
    grid.leaf(*grid.findLeaf(leafOrigin(voxels.front()))).at(low.x(), low.y(), low.z()) = 0.25f;
    std::vector<double> expected(octree.cellCount(), 0.0);
    forEachVoxel(octree, [&](const Index3& v) {
      const std::size_t c = *octree.find(v);
      const float value = grid.at(v);
      if (octree.levels[c] == 0 || value >= 0.5f) expected[c] += value / std::pow(octree.side(c), 3);
    });
    const std::vector<float> values = sampleCells(octree, grid, 0.5f);
    for (std::size_t c = 0; c < octree.cellCount(); ++c) EXPECT_NEAR(values[c], expected[c], 1e-6) << seed;
  }
}

}  // namespace
}  // namespace vdbfuse
