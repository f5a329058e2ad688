// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/surface/field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "octree/random_octree.h"
#include "surface/label_blocks.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/surface/extract.h"

namespace vdbfuse {
namespace {

using test::randomLabels;
using test::randomOctree;
using test::supportAt;

TEST(LabelReader, BlocksHoldWhatTheOctreeSaysOfEachVoxel) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Octree octree = randomOctree(seed, 40, static_cast<int>(seed % 6)).octree;
    const std::vector<CellLabel> labels = randomLabels(octree, seed);
    const CellLabel beyond = seed % 2 == 0 ? CellLabel::Outside : CellLabel::Inside;
    const LabelReader reader(octree, labels, beyond);
    std::array<CellLabel, ScalarGrid::kLeafSize> block;
    for (int x = -8; x <= octree.size.x(); x += 8)
      for (int y = -8; y <= octree.size.y(); y += 8)
        for (int z = -8; z <= octree.size.z(); z += 8) {
          const Index3 origin = octree.origin + Index3(x, y, z);
          reader.readBlock(origin, block.data());
          for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
            const Index3 v = origin + Index3(k / 64, k / 8 % 8, k % 8);
            const auto cell = octree.find(v);
            ASSERT_EQ(block[static_cast<std::size_t>(k)], cell ? labels[*cell] : beyond);
            ASSERT_EQ(reader.at(v), block[static_cast<std::size_t>(k)]);
          }
        }
  }
}

TEST(BoundaryBlocks, HoldEveryVoxelWithinReachOfAnotherLabel) {
  constexpr int kReach = 2;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const Octree octree = randomOctree(seed, 24, 3).octree;
    const std::vector<CellLabel> labels = randomLabels(octree, seed, 0.1);
    const LabelReader reader(octree, labels, CellLabel::Outside);
    const std::vector<Index3> blocks =
        boundaryBlocks(octree, tileCells(octree), labels, CellLabel::Outside, kReach);
    const ScalarGrid grid("blocks", GridFrame{1.0}, 0.0f, blocks);
    EXPECT_EQ(grid.leafCount(), blocks.size());
    test::forEachVoxel(octree, [&](const Index3& v) {
      for (int n = 0; n < 6; ++n) {
        if (reader.at(v) == reader.at(v + Index3((n % 2 * 2 - 1) * Index3::Unit(n / 2)))) continue;
        for (int k = 0; k < 27; ++k) {
          const Index3 near = v + (kReach - 1) * Index3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
          ASSERT_TRUE(grid.findLeaf(leafOrigin(near))) << seed;
        }
      }
    });
  }
}

class SignedField : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Smoothing, SignedField, testing::Values(0.0, 1.0, 2.0));

FieldOptions uncompleted(double smoothing) {
  FieldOptions options;
  options.smoothing_voxels = smoothing;
  options.completion.kind = CompletionOptions::Kind::None;
  options.least_width = 0;
  return options;
}

TEST_P(SignedField, ItsSignIsTheLabelOfEveryVoxelAndTheSurfaceIsClosed) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const test::RandomOctree random = randomOctree(seed, 24, 3);
    const std::vector<CellLabel> labels = randomLabels(random.octree, seed, 0.3);
    for (const CellLabel beyond : {CellLabel::Outside, CellLabel::Inside}) {
      const CellTiles tiles = tileCells(random.octree);
      const std::vector<float> none(random.octree.cellCount(), 0.0f);
      CutOptions energy;
      energy.border = beyond == CellLabel::Outside ? Border::Outside : Border::Solid;
      const ScalarGrid field = signedField({}, {random.octree, tiles, labels, none, none, energy},
                                           supportAt(random.voxels), uncompleted(GetParam()))
                                   .distance;
      const LabelReader reader(random.octree, labels, beyond);
      for (std::size_t i = 0; i < field.leafCount(); ++i) {
        const ScalarGrid::Leaf leaf = field.leaf(i);
        for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
          const float value = leaf.values[static_cast<std::size_t>(k)];
          const bool outside =
              reader.at(leaf.origin + Index3(k / 64, k / 8 % 8, k % 8)) == CellLabel::Outside;
          ASSERT_TRUE(outside ? value > 0 : value < 0) << value;
          ASSERT_LE(std::abs(value), 2.0f);
        }
      }
      const TriangleMesh mesh = extractSurface(field);
      if (!mesh.triangles.empty()) {
        ASSERT_TRUE(isClosedManifold(topology(mesh))) << seed;
      }
    }
  }
}

// One orthographic sensor above a plane of voxels; labels say: inside from `wall` on.
struct Plane {
  JudgedViews judged;
  Octree octree;
  std::vector<CellLabel> labels;
  ScalarGrid support;
  explicit Plane(float depth, int wall) : support("support", GridFrame{1.0}, 5.0f) {
    View view;
    view.projection = Orthographic{24, 24, 0, 1, 0, 1};
    view.map.depth = Image<float>(24, 24, depth);
    judged = believe({view}, {gaussianNoise(), {0.1, 0, 0}, 1, 20});
    judged.views[0].incidence = Image<float>(24, 24, 1.0f);
    octree =
        buildOctree(supportAt({}), 0.5f, Box(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(22, 22, 22)), {0});
    for (std::size_t c = 0; c < octree.cellCount(); ++c)
      labels.push_back(octree.lowest(c).z() >= wall ? CellLabel::Inside : CellLabel::Outside);
  }
  ScalarGrid field(double smoothing) const {
    const CellTiles tiles = tileCells(octree);
    const std::vector<float> none(octree.cellCount(), 0.0f);
    return signedField(judged, {octree, tiles, labels, none, none, {}}, support, uncompleted(smoothing))
        .distance;
  }
};

TEST(SignedFieldOfAPlane, IsTheMeasuredDistanceWhereThereIsSupport) {
  const Plane plane(10.3f, 11);
  const ScalarGrid field = plane.field(0.0);
  for (int z = 9; z <= 12; ++z) EXPECT_NEAR(field.at({12, 12, z}), 10.3 - z, 1e-5) << z;
  EXPECT_NEAR(field.at({12, 12, 8}), 2, 1e-6);
  EXPECT_NEAR(plane.field(1.0).at({12, 12, 10}), 0.3, 0.01);
}

TEST(SignedFieldOfAPlane, IsHalfAVoxelWithoutSupport) {
  Plane plane(10.3f, 11);
  plane.support = ScalarGrid("support", GridFrame{1.0}, 0.0f);
  const ScalarGrid field = plane.field(0.0);
  EXPECT_FLOAT_EQ(field.at({12, 12, 10}), 0.5f);
  EXPECT_FLOAT_EQ(field.at({12, 12, 11}), -0.5f);
}

TEST(SignedFieldOfAPlane, TheLabelDecidesWhereTheMeasurementLiesExactlyAtAVoxel) {
  EXPECT_LT(Plane(10.0f, 10).field(0.0).at({12, 12, 10}), 0);
  EXPECT_GT(Plane(10.0f, 11).field(0.0).at({12, 12, 10}), 0);
}

TEST(SignedFieldOfAPlane, TheMeasurementDecidesOnWhichSideOfTheSurfaceAVoxelLies) {
  EXPECT_NEAR(Plane(9.9f, 11).field(0.0).at({12, 12, 10}), -0.1, 1e-5);
  EXPECT_NEAR(Plane(10.4f, 10).field(1.0).at({12, 12, 10}), 0.4, 0.01);
}

TEST(SignedFieldOfAPlane, AViewThatContradictsTheLabelByFarDoesNotMove) {
  // The sensor sees a surface at 8, the labels put it between 10 and 11: what the sensor says of the outside
  // voxel 10 is 2 voxels behind its measurement.
  EXPECT_FLOAT_EQ(Plane(8.0f, 11).field(0.0).at({12, 12, 10}), 0.5f);
}

}  // namespace
}  // namespace vdbfuse
