// SPDX-License-Identifier: Apache-2.0
#include "fusion/band_leaves.h"

#include <gtest/gtest.h>

#include <set>

#include "fusion/scenes.h"
#include "vdbfuse/base/parallel.h"
#include "vdbfuse/geometry/projector.h"
#include "vdbfuse/volume/leaf_index.h"

namespace vdbfuse {
namespace {

constexpr double kTruncation = 0.08;
const GridFrame kFrame{0.02, {0.003, -0.001, 0.002}};

std::vector<Index3> leavesOf(const View& view, const std::optional<Box>& domain = {}) {
  return bandLeaves(view, view.map.depth, DepthTiles(view.map.depth), kFrame, {kTruncation, domain});
}

// A sphere before a far wall, with holes: jumps everywhere along its silhouette.
View sphereBeforeWall(const Projection& projection) {
  View view;
  view.projection = projection;
  view.world_from_camera = lookAt({0.3, 0.4, 2}, {0, 0, 0}, {0, 1, 0});
  view.map.depth = Image<float>(imageWidth(projection), imageHeight(projection));
  Random random(7);
  for (int y = 0; y < view.map.depth.height(); ++y) {
    for (int x = 0; x < view.map.depth.width(); ++x) {
      const Eigen::Vector3d start = view.world_from_camera * unproject(projection, x, y, 0.0),
                            step = view.world_from_camera * unproject(projection, x, y, 1.0) - start;
      const double hit = test::sphereCaster(0.5)(start, step.normalized());
      const double depth = hit > 0 ? hit / step.norm() : 3 + 0.2 * random.uniform();
      if (random.uniform() > 0.1) view.map.depth(x, y) = static_cast<float>(depth);
    }
  }
  return view;
}

TEST(BandLeaves, HoldEveryVoxelWhoseNearestPixelIsWithinTheTruncation) {
  const Projection sensors[] = {
      Pinhole{50, 37, 45, 45, 24.5, 18, {}}, Pinhole{50, 37, 45, 45, 24.5, 18, {0.1, 0.01, 0, 0, 0}},
      Spherical{50, 37, -0.5, 1.0 / 49, -0.4, 0.8 / 36}, Orthographic{50, 37, -1, 2.0 / 49, -0.8, 1.6 / 36}};
  for (const Projection& projection : sensors) {
    const View view = sphereBeforeWall(projection);
    const std::vector<Index3> leaves = leavesOf(view);
    ASSERT_TRUE(std::is_sorted(leaves.begin(), leaves.end(), originBefore));
    const Projector projector(view.projection, view.world_from_camera);
    std::size_t missing = 0, inside = 0;
    for (int x = -80; x < 80; ++x) {
      for (int y = -80; y < 80; ++y) {
        for (int z = -80; z < 60; ++z) {
          const auto seen = projector(kFrame.toWorld(Index3(x, y, z)));
          if (!seen) continue;
          const float measured = view.map.depth(seen->x, seen->y);
          if (measured == kInvalidDepth || std::abs(measured - seen->depth) > kTruncation) continue;
          ++inside;
          missing +=
              std::binary_search(leaves.begin(), leaves.end(), leafOrigin({x, y, z}), originBefore) ? 0 : 1;
        }
      }
    }
    EXPECT_GT(inside, 5000u) << projection.index();
    EXPECT_EQ(missing, 0u) << projection.index();
  }
}

TEST(BandLeaves, AreFewMoreThanThoseThatHoldSuchVoxels) {
  const View view = sphereBeforeWall(Pinhole{320, 240, 290, 290, 159.5, 119.5, {}});
  const std::vector<Index3> leaves = leavesOf(view);
  const Projector projector(view.projection, view.world_from_camera);
  std::size_t used = 0;
  for (const Index3& origin : leaves) {
    bool is_used = false;
    for (int k = 0; k < ScalarGrid::kLeafSize && !is_used; ++k) {
      const auto seen = projector(kFrame.toWorld(Index3(origin + leafOffset(k))));
      const float measured = seen ? view.map.depth(seen->x, seen->y) : kInvalidDepth;
      is_used = measured != kInvalidDepth && std::abs(measured - seen->depth) <= kTruncation;
    }
    used += is_used ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(used), 0.6 * static_cast<double>(leaves.size()));
}

TEST(BandLeaves, AreTheSameForEveryNumberOfThreads) {
  const View view = sphereBeforeWall(Pinhole{320, 240, 290, 290, 159.5, 119.5, {}});
  const ThreadLimit one(1);
  const std::vector<Index3> expected = leavesOf(view);
  const ThreadLimit four(4);
  EXPECT_EQ(leavesOf(view), expected);
}

TEST(BandLeaves, AnEmptyDepthMapHasNone) {
  View view = sphereBeforeWall(Pinhole{50, 37, 45, 45, 24.5, 18, {}});
  view.map.depth = Image<float>(50, 37);
  EXPECT_TRUE(leavesOf(view).empty());
}

}  // namespace
}  // namespace vdbfuse
