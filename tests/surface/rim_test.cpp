// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/rim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "vdbfuse/base/errors.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/surface/extract.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

// A plane at z = 7.3 over 24 × 24 voxels, two voxels of distance known to either side.
ScalarGrid planeField(const std::function<bool(const Index3&)>& is_known) {
  std::vector<Index3> origins;
  for (int x = 0; x < 24; x += 8)
    for (int y = 0; y < 24; y += 8)
      for (int z = 0; z < 16; z += 8) origins.emplace_back(x, y, z);
  ScalarGrid grid("surface", {1.0}, kUnknown, origins);
  grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const Index3 v = leaf.origin + leafOffset(k);
      const auto distance = static_cast<float>(v.z() - 7.3);
      if (std::abs(distance) < 3 && is_known(v)) leaf.values[static_cast<std::size_t>(k)] = distance;
    }
  });
  return grid;
}

bool everywhere(const Index3&) { return true; }

TEST(CloseGaps, FillsSingleVoxelsWithWhatLeadsThere) {
  const auto hole = [](const Index3& v) { return v != Index3(10, 11, 8) && v != Index3(15, 15, 7); };
  const ScalarGrid closed = closeGaps(planeField(hole));
  EXPECT_NEAR(closed.at({10, 11, 8}), 0.7, 1e-5);
  EXPECT_NEAR(closed.at({15, 15, 7}), -0.3, 1e-5);
  const TopologyReport whole = topology(extractSurface(closeGaps(planeField(everywhere)))),
                       mended = topology(extractSurface(closed));
  EXPECT_EQ(mended.open_edges, whole.open_edges);
}

TEST(CloseGaps, GoesOneVoxelFurtherAtTheRimAndKeepsWhatIsKnown) {
  const ScalarGrid field = planeField(everywhere), closed = closeGaps(field);
  EXPECT_TRUE(std::isnan(field.at({24, 12, 8})));
  EXPECT_NEAR(closed.at({24, 12, 8}), 0.7, 1e-5);
  EXPECT_TRUE(std::isnan(closed.at({25, 12, 8})));
  EXPECT_TRUE(std::isnan(closed.at({12, 12, 12})));  // no surface beside it
  for (int x = 0; x < 24; ++x) EXPECT_EQ(closed.at({x, 3, 7}), field.at({x, 3, 7}));
}

TEST(TrimRim, LeavesAClosedMeshAlone) {
  ScalarGrid ball(
      "surface", {1.0}, kUnknown,
      {{0, 0, 0}, {-8, 0, 0}, {0, -8, 0}, {-8, -8, 0}, {0, 0, -8}, {-8, 0, -8}, {0, -8, -8}, {-8, -8, -8}});
  ball.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
      leaf.values[static_cast<std::size_t>(k)] =
          static_cast<float>((leaf.origin + leafOffset(k)).cast<double>().norm() - 5);
  });
  TriangleMesh mesh = extractSurface(ball);
  const std::size_t before = mesh.triangles.size();
  EXPECT_EQ(trimRim(3, mesh), 0u);
  EXPECT_EQ(mesh.triangles.size(), before);
}

TEST(TrimRim, TakesOneRingFromAStraightRim) {
  TriangleMesh mesh = extractSurface(planeField(everywhere));
  const double before = area(mesh);
  trimRim(3, mesh);
  EXPECT_LT(area(mesh), before - 3.5 * 23);
  EXPECT_GT(area(mesh), before - 4.5 * 23);  // corners are rounded
}

TEST(TrimRim, CutsOffFraysAndPiecesAndStaysManifold) {
  Random random(4);
  // Beyond x = 12 half of the voxels are known: hundreds of holes and pieces.
  std::vector<bool> known(24 * 24 * 16);
  for (std::size_t i = 0; i < known.size(); ++i) known[i] = random.uniform() < 0.8;
  const auto frayed = [&](const Index3& v) {
    return v.x() < 12 || known[static_cast<std::size_t>((v.x() * 24 + v.y()) * 16 + v.z())];
  };
  TriangleMesh mesh = extractSurface(planeField(frayed));
  const TopologyReport before = topology(mesh);
  EXPECT_GT(before.components, 5u);
  EXPECT_GT(trimRim(2, mesh), 10u);
  const TopologyReport after = topology(mesh);
  EXPECT_EQ(after.components, 1u);
  EXPECT_EQ(after.nonmanifold_edges, 0u);
  EXPECT_EQ(after.nonmanifold_vertices, 0u);
  EXPECT_LT(after.open_edges, before.open_edges / 2);
  EXPECT_GT(area(mesh), 0.9 * 9 * 23);
}

TEST(TrimRim, RefusesNoRings) {
  TriangleMesh mesh;
  EXPECT_THROW(trimRim(0, mesh), InvalidArgument);
}

}  // namespace
}  // namespace vdbfuse
