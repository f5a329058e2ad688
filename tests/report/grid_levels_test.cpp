// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/report/grid_levels.h"

#include <gmock/gmock.h>

#include <cmath>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

// One voxel of value 1 at the origin, and around it a coarser one of value 2, twice as wide.
std::vector<ScalarGrid> twoLevels() {
  std::vector<ScalarGrid> grids;
  grids.emplace_back("sigma", GridFrame{1.0}, kUnknown, std::vector<Index3>{{0, 0, 0}});
  grids.back().leaf(0).at(0, 0, 0) = 1;
  grids.emplace_back("sigma_level1", GridFrame{2.0, Eigen::Vector3d::Constant(0.5)}, kUnknown,
                     std::vector<Index3>{{0, 0, 0}});
  grids.back().leaf(0).at(0, 0, 0) = 2;
  return grids;
}

TEST(GridLevels, APointIsInTheFinestVoxelWithAValue) {
  const std::vector<ScalarGrid> grids = twoLevels();
  const GridLevels levels(grids, "sigma");
  EXPECT_EQ(levels.at({0.2, -0.2, 0}).value, 1);
  EXPECT_EQ(levels.at({0.2, -0.2, 0}).level, 0u);
  EXPECT_EQ(levels.at({1, 1, 1}).value, 2);
  EXPECT_EQ(levels.at({1, 1, 1}).level, 1u);
  EXPECT_TRUE(std::isnan(levels.at({3, 3, 3}).value));
}

TEST(GridLevels, TheBoxReachesToTheFacesOfAllVoxelsWithAValue) {
  const std::vector<ScalarGrid> grids = twoLevels();
  const Box box = GridLevels(grids, "sigma").box();
  EXPECT_TRUE(box.min().isApproxToConstant(-0.5));
  EXPECT_TRUE(box.max().isApproxToConstant(1.5));
  EXPECT_TRUE(GridLevels(std::vector<const ScalarGrid*>{}).box().isEmpty());
}

TEST(GridLevels, AGridThatIsNotThereIsNamed) {
  const std::vector<ScalarGrid> grids = twoLevels();
  try {
    const GridLevels levels(grids, "rho");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_STREQ(error.what(), "grid: there is none called 'rho'");
  }
}

}  // namespace
}  // namespace vdbfuse
