// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/live_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "vdbfuse/base/random.h"
#include "vdbfuse/surface/extract.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

const GridFrame kFrame{0.5, {1, 2, 3}};
using Values = std::array<float, ScalarGrid::kLeafSize>;

// A wavy surface with noise and unknown voxels: all cases of cubes, and rims.
Values randomValues(const Index3& origin, Random& random) {
  Values values;
  for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
    const Index3 v = origin + leafOffset(k);
    values[static_cast<std::size_t>(k)] =
        random.uniform() < 0.05 ? kUnknown
                                : static_cast<float>(v.x() + v.y() - v.z() + random.uniform(-6, 6));
  }
  return values;
}

void expectTheSame(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.vertices.size(), b.vertices.size());
  for (std::size_t v = 0; v < a.vertices.size(); ++v) ASSERT_EQ(a.vertices[v], b.vertices[v]);
}

TEST(LiveSurface, IsWhatTheWholeFieldHasAfterEveryChange) {
  Random random(5);
  LiveSurface live(kFrame);
  std::map<std::array<int, 3>, Values> field;
  for (int step = 0; step < 25; ++step) {
    for (int change = 0; change < 6; ++change) {
      const auto place = [&] { return 8 * static_cast<int>(random.uniform(-2, 3)); };
      const Index3 origin(place(), place(), place());
      const Values values = randomValues(origin, random);
      field[{origin.x(), origin.y(), origin.z()}] = values;
      live.set(origin, values);
    }
    std::vector<Index3> origins;
    for (const auto& [o, values] : field) origins.emplace_back(o[0], o[1], o[2]);
    ScalarGrid grid("surface", kFrame, kUnknown, origins);
    grid.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
      const Values& values = field.at({leaf.origin.x(), leaf.origin.y(), leaf.origin.z()});
      std::copy(values.begin(), values.end(), leaf.values.begin());
    });
    expectTheSame(live.mesh(), extractSurface(grid));
  }
}

TEST(LiveSurface, WorksOnlyOnLeavesThatTouchAChange) {
  Random random(6);
  LiveSurface live(kFrame);
  for (int x = 0; x < 10; ++x)
    for (int y = 0; y < 10; ++y)
      for (int z = 0; z < 3; ++z)
        live.set({8 * x, 8 * y, 8 * z}, randomValues({8 * x, 8 * y, 8 * z}, random));
  const TriangleMesh all = live.mesh();
  EXPECT_EQ(live.meshedLeaves(), 300u);
  live.mesh();
  EXPECT_EQ(live.meshedLeaves(), 0u);
  live.set({40, 40, 8}, randomValues({40, 40, 8}, random));
  live.mesh();
  EXPECT_GT(live.meshedLeaves(), 0u);
  EXPECT_LE(live.meshedLeaves(), 27u);
}

using Points = std::array<std::array<float, 3>, 3>;

// Triangles by the places of their corners, the first of them first: whatever the vertices' numbers.
std::multiset<Points> trianglesOf(const TriangleMesh& mesh) {
  std::multiset<Points> result;
  for (const Triangle& triangle : mesh.triangles) {
    Points points;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3f& v = mesh.vertices[triangle[k]];
      points[k] = {v.x(), v.y(), v.z()};
    }
    std::rotate(points.begin(), std::min_element(points.begin(), points.end()), points.end());
    result.insert(points);
  }
  return result;
}

TEST(LiveSurface, BlocksAddUpToTheMeshAfterEveryChange) {
  Random random(7);
  LiveSurface live(kFrame);
  std::map<std::array<int, 3>, TriangleMesh> blocks;
  for (int step = 0; step < 20; ++step) {
    for (int change = 0; change < 20; ++change) {
      const auto place = [&] { return 8 * static_cast<int>(random.uniform(-5, 6)); };
      const Index3 origin(place(), place(), place());
      Values values = randomValues(origin, random);
      if (change % 4 == 0) values.fill(kUnknown);
      live.set(origin, values);
    }
    for (SurfaceBlock& block : live.changedBlocks()) {
      EXPECT_EQ(block.origin.x() % LiveSurface::kBlockSide, 0);
      blocks[{block.origin.x(), block.origin.y(), block.origin.z()}] = std::move(block.mesh);
    }
    std::multiset<Points> all;
    for (const auto& [origin, mesh] : blocks) all.merge(trianglesOf(mesh));
    ASSERT_EQ(all, trianglesOf(live.mesh()));
  }
  EXPECT_GT(blocks.size(), 10u);
}

TEST(LiveSurface, BlocksAgreeAboutTheNormalsOnTheirBorders) {
  LiveSurface live(kFrame);
  std::map<std::array<float, 3>, Eigen::Vector3f> normals;
  std::size_t shared = 0;
  const auto set_ball = [&](float radius) {
    for (int x = -48; x < 48; x += 8)
      for (int y = -48; y < 48; y += 8)
        for (int z = -48; z < 48; z += 8) {
          Values values;
          for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
            values[static_cast<std::size_t>(k)] =
                (Index3(x, y, z) + leafOffset(k)).cast<float>().norm() - radius;
          live.set({x, y, z}, values);
        }
  };
  set_ball(40.3f);
  for (const SurfaceBlock& block : live.changedBlocks()) {
    ASSERT_EQ(block.mesh.normals.size(), block.mesh.vertices.size());
    for (std::size_t v = 0; v < block.mesh.vertices.size(); ++v) {
      const Eigen::Vector3f& p = block.mesh.vertices[v];
      const auto [entry, is_new] = normals.try_emplace({p.x(), p.y(), p.z()}, block.mesh.normals[v]);
      shared += !is_new;
      ASSERT_EQ(entry->second, block.mesh.normals[v]);
      ASSERT_GT(block.mesh.normals[v].dot((p - Eigen::Vector3f(1, 2, 3)).normalized()), 0.98f);
    }
  }
  EXPECT_GT(shared, 500u);
}

TEST(LiveSurface, NamesOnlyBlocksThatChangedAndEmptyOnesOnce) {
  LiveSurface live(kFrame);
  Values plane, unknown;
  for (int k = 0; k < ScalarGrid::kLeafSize; ++k)
    plane[static_cast<std::size_t>(k)] = static_cast<float>(leafOffset(k).z()) - 3.5f;
  unknown.fill(kUnknown);
  const auto set_row = [&](int begin, int end, const Values& values) {
    for (int x = begin; x < end; x += 8)
      for (const int y : {8, 16}) live.set({x, y, 8}, values);
  };
  set_row(-64, 64, plane);
  EXPECT_EQ(live.changedBlocks().size(), 4u);
  EXPECT_TRUE(live.changedBlocks().empty());
  set_row(0, 32, unknown);
  const std::vector<SurfaceBlock> blocks = live.changedBlocks();
  ASSERT_EQ(blocks.size(), 3u);  // the neighbours' borders, too
  EXPECT_EQ(blocks[1].origin, Index3(0, 0, 0));
  EXPECT_TRUE(blocks[1].mesh.triangles.empty());
  EXPECT_FALSE(blocks[0].mesh.triangles.empty());
  set_row(8, 24, unknown);
  for (const SurfaceBlock& block : live.changedBlocks()) EXPECT_NE(block.origin, Index3(0, 0, 0));
}

TEST(LiveSurface, StartsEmpty) { EXPECT_TRUE(LiveSurface(kFrame).mesh().triangles.empty()); }

}  // namespace
}  // namespace vdbfuse
