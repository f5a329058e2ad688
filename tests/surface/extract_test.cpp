// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/extract.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "vdbfuse/base/parallel.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

using Value = std::function<float(const Index3&)>;

// A field on `leaves` 8³ blocks along each axis from `origin`.
ScalarGrid fieldOf(const Value& value, const Index3& leaves, const GridFrame& frame = {1.0},
                   const Index3& origin = {-8, 0, 8}) {
  std::vector<Index3> origins;
  for (int x = 0; x < leaves.x(); ++x)
    for (int y = 0; y < leaves.y(); ++y)
      for (int z = 0; z < leaves.z(); ++z) origins.push_back(origin + 8 * Index3(x, y, z));
  ScalarGrid grid("surface", frame, kUnknown, origins);
  grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const Index3 v = leaf.origin + Index3(k / 64, k / 8 % 8, k % 8);
      leaf.values[static_cast<std::size_t>(k)] = value(v);
    }
  });
  return grid;
}

// Random signs (and values) within [1, side] of the first voxel, outside beyond.
Value randomLabels(std::uint64_t seed, int side, double inside) {
  auto values = std::make_shared<std::vector<float>>();
  Random random(seed);
  for (int i = 0; i < side * side * side; ++i) {
    const double magnitude = seed % 4 == 0 ? 1.0 : random.uniform(1e-6, 1);
    values->push_back(static_cast<float>(random.uniform() < inside ? -magnitude : magnitude));
  }
  return [values, side](const Index3& v) {
    const Index3 p = v - Index3(-7, 1, 9);
    if ((p.array() < 0).any() || (p.array() >= side).any()) return 1.0f;
    return (*values)[static_cast<std::size_t>((p.x() * side + p.y()) * side + p.z())];
  };
}

TEST(ExtractSurface, AllCasesAloneAreClosedManifoldsAroundTheirInside) {
  for (int mask = 1; mask < 256; ++mask) {
    const Value value = [&](const Index3& v) {
      const Index3 p = v - Index3(-1, 7, 15);  // across the corner of eight leaves
      if ((p.array() < 0).any() || (p.array() > 1).any()) return 1.0f;
      return mask >> (p.x() | p.y() << 1 | p.z() << 2) & 1 ? -1.0f : 1.0f;
    };
    const TriangleMesh mesh = extractSurface(fieldOf(value, {2, 2, 2}));
    ASSERT_TRUE(isClosedManifold(topology(mesh))) << mask;
    ASSERT_GT(signedVolume(mesh), 0) << mask;
  }
}

TEST(ExtractSurface, AllPairsOfNeighbouringCubesAreClosedManifolds) {
  for (int mask = 1; mask < 4096; ++mask) {
    const Value value = [&](const Index3& v) {
      const Index3 p = v - Index3(-2, 3, 12);
      if ((p.array() < 0).any() || p.x() > 2 || p.y() > 1 || p.z() > 1) return 1.0f;
      return mask >> (p.x() * 4 + p.y() * 2 + p.z()) & 1 ? -1.0f : 1.0f;
    };
    const TriangleMesh mesh = extractSurface(fieldOf(value, {2, 1, 1}));
    ASSERT_TRUE(isClosedManifold(topology(mesh))) << mask;
    ASSERT_GT(signedVolume(mesh), 0) << mask;
  }
}

TEST(ExtractSurface, RandomLabelsGiveAClosedManifold) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const int side = 2 + static_cast<int>(seed % 11);
    const double inside = 0.1 + 0.2 * static_cast<double>(seed % 5);
    const TriangleMesh mesh = extractSurface(fieldOf(randomLabels(seed, side, inside), {2, 2, 2}));
    if (mesh.triangles.empty()) continue;
    const TopologyReport report = topology(mesh);
    ASSERT_TRUE(isClosedManifold(report)) << seed;
    ASSERT_EQ(report.zero_area_triangles, 0u) << seed;
    ASSERT_EQ(report.used_vertices, mesh.vertices.size());
    ASSERT_GT(signedVolume(mesh), 0);
  }
}

TEST(ExtractSurface, UnknownVoxelsLeaveAnOpenRimThatIsManifold) {
  std::size_t open = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Random random(seed, 1);
    const double unknown = seed % 3 == 0 ? 0.02 : 0.15;
    const Value labels = randomLabels(seed, 12, 0.4);
    const TriangleMesh mesh = extractSurface(fieldOf(
        [&](const Index3& v) {
          Random here(
              seed, static_cast<std::uint64_t>(v.x() + 100 + 1000 * (v.y() + 100) + 1000000 * (v.z() + 100)));
          return here.uniform() < unknown ? kUnknown : labels(v);
        },
        {2, 2, 2}));
    const TopologyReport report = topology(mesh);
    ASSERT_EQ(report.nonmanifold_edges, 0u) << seed;
    ASSERT_EQ(report.nonmanifold_vertices, 0u) << seed;
    ASSERT_EQ(report.inconsistent_edges, 0u) << seed;
    ASSERT_EQ(report.nonfinite_vertices, 0u) << seed;
    ASSERT_EQ(report.used_vertices, mesh.vertices.size()) << seed;
    open += report.open_edges;
  }
  EXPECT_GT(open, 1000u);
}

TEST(ExtractSurface, LeavesThatAreMissingAreUnknown) {
  // A plane z = 12.3 on a 2 × 2 arrangement of leaves, one of which is missing.
  ScalarGrid grid("surface", GridFrame{1.0}, kUnknown, {{0, 0, 8}, {8, 0, 8}, {0, 8, 8}});
  grid.forEachLeaf([](const ScalarGrid::Leaf& leaf) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
      leaf.values[static_cast<std::size_t>(k)] = static_cast<float>(leaf.origin.z() + k % 8) - 12.3f;
  });
  const TriangleMesh mesh = extractSurface(grid);
  EXPECT_NEAR(area(mesh), 15 * 15 - 8 * 8, 1e-3);
  const TopologyReport report = topology(mesh);
  EXPECT_EQ(report.open_edges, 60u);
  EXPECT_EQ(report.nonmanifold_vertices, 0u);
  for (const Eigen::Vector3f& v : mesh.vertices) EXPECT_NEAR(v.z(), 12.3, 1e-5);
}

TEST(ExtractSurface, TheVerticesOfASphereLieOnIt) {
  const GridFrame frame{0.1, {5, -3, 2}};
  const Eigen::Vector3d centre(3.3, 7.9, 16.2);
  const double radius = 6.4;
  const TriangleMesh mesh = extractSurface(fieldOf(
      [&](const Index3& v) { return static_cast<float>((v.cast<double>() - centre).norm() - radius); },
      {3, 3, 3}, frame));
  const TopologyReport report = topology(mesh);
  EXPECT_TRUE(isClosedManifold(report));
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.euler_number, 2);
  for (const Eigen::Vector3f& v : mesh.vertices)
    ASSERT_NEAR((frame.toIndex(v.cast<double>()) - centre).norm(), radius, 0.1);
  EXPECT_NEAR(signedVolume(mesh), 4.0 / 3 * M_PI * std::pow(0.64, 3), 0.02 * std::pow(0.64, 3) * 4.19);
}

TEST(ExtractSurface, ZeroCountsAsOutside) {
  const auto one = [](float at_centre) {
    return extractSurface(
        fieldOf([&](const Index3& v) { return v == Index3(0, 4, 12) ? at_centre : 1.0f; }, {2, 1, 1}));
  };
  EXPECT_TRUE(one(0.0f).triangles.empty());
  EXPECT_EQ(one(-1e-30f).triangles.size(), 8u);
}

TEST(ExtractSurface, GivesTheSameBytesForOneToFourThreads) {
  const ScalarGrid field = fieldOf(randomLabels(3, 30, 0.5), {5, 5, 5});
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    const TriangleMesh mesh = extractSurface(field);
    return std::pair(mesh.vertices, mesh.triangles);
  };
  const auto expected = run(1);
  EXPECT_GT(expected.second.size(), 10000u);
  EXPECT_EQ(run(2), expected);
  EXPECT_EQ(run(4), expected);
}

TEST(ExtractSurface, OfNothingIsNothing) {
  EXPECT_TRUE(extractSurface(ScalarGrid("surface", GridFrame{1.0}, kUnknown)).vertices.empty());
  EXPECT_TRUE(extractSurface(fieldOf([](const Index3&) { return -1.0f; }, {1, 1, 1})).triangles.empty());
}

}  // namespace
}  // namespace vdbfuse
