// SPDX-License-Identifier: Apache-2.0
#include "surface/simple_point.h"

#include <gtest/gtest.h>

#include <bit>

#include "vdbfuse/base/random.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/surface/extract.h"

namespace vdbfuse {
namespace {

constexpr Neighbourhood kCentre = neighbourBit(0, 0, 0);

Neighbourhood randomNeighbourhood(Random& random, double inside) {
  Neighbourhood mask = 0;
  for (int i = 0; i < 27; ++i)
    if (random.uniform() < inside) mask |= Neighbourhood{1} << i;
  return mask;
}

// The surface around a neighbourhood, cut open by nothing: outside all around, or inside within a shell.
TopologyReport surfaceOf(Neighbourhood inside, bool in_matter) {
  ScalarGrid grid("surface", {1.0}, in_matter ? -1.0f : 1.0f, {Index3(0, 0, 0)});
  const ScalarGrid::Leaf leaf = grid.leaf(0);
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z) {
        const bool shell = x == 0 || y == 0 || z == 0 || x == 7 || y == 7 || z == 7;
        if (shell) leaf.at(x, y, z) = 1.0f;
        const Index3 d = Index3(x, y, z) - Index3(3, 3, 3);
        if (d.cwiseAbs().maxCoeff() <= 1)
          leaf.at(x, y, z) = inside & neighbourBit(d.x(), d.y(), d.z()) ? -1.0f : 1.0f;
      }
  return topology(extractSurface(grid));
}

TEST(SimplePoint, ChangesNeitherComponentsNorHandlesOfTheExtractedSurface) {
  Random random(3);
  int simple = 0;
  for (int i = 0; i < 6000; ++i) {
    const Neighbourhood mask = randomNeighbourhood(random, 0.15 + 0.1 * (i % 8));
    if (!isSimple(mask)) continue;
    ++simple;
    for (const bool in_matter : {false, true}) {
      const TopologyReport with = surfaceOf(mask | kCentre, in_matter),
                           without = surfaceOf(mask & ~kCentre, in_matter);
      ASSERT_EQ(with.components, without.components) << mask;
      ASSERT_EQ(with.euler_number, without.euler_number) << mask;
    }
  }
  EXPECT_GT(simple, 500);
}

TEST(SimplePoint, IsRefusedOnlyWhereTheSurfaceAroundItChanges) {
  // A change that keeps components and handles of solid and surroundings is a simple one: what is refused
  // changes the surface, seen alone or within matter.
  Random random(4);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const Neighbourhood mask = randomNeighbourhood(random, 0.15 + 0.1 * (i % 8));
    if (isSimple(mask)) continue;
    ++refused;
    bool changes = false;
    for (const bool in_matter : {false, true}) {
      const TopologyReport with = surfaceOf(mask | kCentre, in_matter),
                           without = surfaceOf(mask & ~kCentre, in_matter);
      changes |= with.components != without.components || with.euler_number != without.euler_number;
    }
    ASSERT_TRUE(changes) << mask;
  }
  EXPECT_GT(refused, 500);
}

TEST(SimplePoint, KnowsTheOneVoxelTheTunnelAndTheBridge) {
  const Neighbourhood all = (Neighbourhood{1} << 27) - 1;
  EXPECT_FALSE(isSimple(0)) << "a voxel alone";
  EXPECT_FALSE(isSimple(all)) << "a cavity";
  EXPECT_TRUE(isSimple(neighbourBit(1, 0, 0))) << "the end of a line";
  EXPECT_FALSE(isSimple(neighbourBit(1, 0, 0) | neighbourBit(-1, 0, 0))) << "the middle of a line";
  EXPECT_FALSE(isSimple(all & ~neighbourBit(0, 0, 1) & ~neighbourBit(0, 0, -1))) << "a tunnel through a wall";
  EXPECT_TRUE(isSimple(neighbourBit(1, 1, 0))) << "insides join across edges";
  EXPECT_FALSE(isSimple(neighbourBit(1, 1, 1))) << "but not across corners";
}

}  // namespace
}  // namespace vdbfuse
