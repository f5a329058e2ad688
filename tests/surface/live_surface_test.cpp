// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/live_surface.h"

#include <gtest/gtest.h>

#include <map>

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

TEST(LiveSurface, StartsEmpty) { EXPECT_TRUE(LiveSurface(kFrame).mesh().triangles.empty()); }

}  // namespace
}  // namespace vdbfuse
