// SPDX-License-Identifier: Apache-2.0
#include "surface/settle.h"

#include <gtest/gtest.h>

#include "surface/boundary.h"
#include "vdbfuse/base/random.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/surface/extract.h"

namespace vdbfuse {
namespace {

BlockField cube(int blocks) {
  std::vector<Index3> origins;
  appendBlocks(Index3::Zero(), Index3::Constant(8 * blocks - 1), origins);
  BlockField field{{1.0}, BlockSet(origins), {}};
  field.values.resize(field.blocks.valueCount());
  return field;
}

template <class Value>
void fill(BlockField& field, const Value& value) {
  for (std::size_t b = 0; b < field.blocks.count(); ++b) {
    for (std::size_t i = 0; i < kBlockSize; ++i)
      field.block(b)[i] = value(Index3(field.blocks.origin(b) + leafOffset(static_cast<int>(i))));
  }
}

TopologyReport surfaceOf(const BlockField& sides) {
  ScalarGrid grid("surface", sides.frame, kUnknown, sides.blocks.origins());
  for (std::size_t b = 0; b < sides.blocks.count(); ++b)
    std::copy_n(sides.block(b), kBlockSize, grid.leaf(*grid.findLeaf(sides.blocks.origin(b))).values.begin());
  return topology(extractSurface(grid));
}

bool isDeep(const Index3& v, int side) { return v.minCoeff() > 1 && v.maxCoeff() < side - 2; }

TEST(SettleSides, MovesASurfaceToWhereTheFieldSaysItIs) {
  BlockField sides = cube(3), field = sides;
  fill(sides, [](const Index3& v) { return v.z() < 12 ? -1.0f : 1.0f; });
  fill(field, [](const Index3& v) { return static_cast<float>(v.z()) - 12.7f; });
  std::vector<float> may_change(field.values.size());
  BlockField marks = cube(3);
  fill(marks, [](const Index3& v) { return isDeep(v, 24) ? 1.0f : 0.0f; });
  EXPECT_EQ(settleSides(field.values, marks.values, sides), 20u * 20u);
  for (std::size_t i = 0; i < field.values.size(); ++i)
    EXPECT_TRUE(marks.values[i] == 0 || field.values[i] * sides.values[i] > 0);
  EXPECT_EQ(settleSides(field.values, may_change, sides), 0u) << "where nothing may change";
}

TEST(SettleSides, NeverChangesTheTopologyWhateverTheFieldAsksFor) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    BlockField sides = cube(2), field = sides, marks = sides;
    fill(sides, [&](const Index3& v) {
      return isDeep(v, 16) && random.uniform() < 0.1 + 0.02 * static_cast<double>(seed) ? -1.0f : 1.0f;
    });
    fill(field, [&](const Index3&) { return static_cast<float>(random.uniform(-1, 1)); });
    fill(marks, [](const Index3& v) { return isDeep(v, 16) ? 1.0f : 0.0f; });
    const TopologyReport before = surfaceOf(sides);
    const std::size_t changed = settleSides(field.values, marks.values, sides);
    const TopologyReport after = surfaceOf(sides);
    EXPECT_GT(changed, 0u);
    EXPECT_EQ(before.components, after.components) << seed;
    EXPECT_EQ(before.euler_number, after.euler_number) << seed;
  }
}

}  // namespace
}  // namespace vdbfuse
