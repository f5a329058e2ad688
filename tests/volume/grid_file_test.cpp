// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <cmath>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;

const GridFrame kFrame{0.25, {1, -2, 3}};

ScalarGrid someField() {
  ScalarGrid grid("rho", kFrame, 1.0f, {{0, 0, 0}, {-8, 16, 0}, {64, 0, 0}});
  grid.leaf(*grid.findLeaf({0, 0, 0})).at(1, 2, 3) = 0.25f;
  grid.leaf(*grid.findLeaf({-8, 16, 0})).at(7, 7, 7) = -5.0f;
  grid.metadata()["about"] = "a test";
  return grid;
}

// A distance that is known in a slab only: one voxel is exactly at the cut-off, one exactly on the surface.
ScalarGrid someLevelSet() {
  ScalarGrid grid("surface", kFrame, kUnknown, {{0, 0, 0}, {8, 0, 0}});
  grid.leaf(0).at(0, 0, 0) = 0.5f, grid.leaf(0).at(0, 0, 1) = 0.0f, grid.leaf(0).at(0, 0, 2) = -0.5f;
  grid.setKind(GridKind::LevelSet);
  return grid;
}

openvdb::FloatGrid::Ptr openPlainly(const std::filesystem::path& path, const std::string& name) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open();
  return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(name));
}

TEST(GridFile, WhatIsWrittenIsReadBack) {
  const TemporaryFolder folder;
  const ScalarGrid field = someField(), surface = someLevelSet();
  writeGrids(folder / "g.vdb", {&field, &surface});
  ScalarGrid read = readGrid(folder / "g.vdb", "rho");
  EXPECT_EQ(read.name(), "rho");
  EXPECT_EQ(read.background(), 1.0f);
  EXPECT_EQ(read.frame().voxel, 0.25);
  EXPECT_EQ(read.frame().offset, kFrame.offset);
  EXPECT_EQ(read.at({1, 2, 3}), 0.25f);
  EXPECT_EQ(read.at({-1, 23, 7}), -5.0f);
  EXPECT_EQ(read.at({64, 0, 0}), 1.0f);
  const std::map<std::string, std::string> expected = {{"about", "a test"}};
  EXPECT_EQ(read.metadata(), expected);
  EXPECT_EQ(readGrid(folder / "g.vdb").name(), "rho");
}

TEST(GridFile, UnknownVoxelsOfALevelSetStayUnknownAndKnownOnesKnown) {
  const TemporaryFolder folder;
  const ScalarGrid surface = someLevelSet();
  writeGrids(folder / "g.vdb", {&surface});
  const ScalarGrid read = readGrid(folder / "g.vdb", "surface");
  EXPECT_EQ(read.at({0, 0, 0}), 0.5f);
  EXPECT_EQ(read.at({0, 0, 1}), 0.0f);
  EXPECT_EQ(read.at({0, 0, 2}), -0.5f);
  EXPECT_TRUE(std::isnan(read.at({0, 0, 3})));
  EXPECT_TRUE(std::isnan(read.at({8, 0, 0})));
  EXPECT_TRUE(std::isnan(read.at({100, 0, 0})));
  EXPECT_TRUE(std::isnan(read.background()));
  // And once more: reading and writing change nothing.
  writeGrids(folder / "again.vdb", {&read});
  const ScalarGrid again = readGrid(folder / "again.vdb");
  EXPECT_EQ(again.at({0, 0, 2}), -0.5f);
  EXPECT_TRUE(std::isnan(again.at({0, 0, 3})));
}

TEST(GridFile, AFieldWithUnknownVoxelsKeepsItsZerosAndTheyStayUnknown) {
  const TemporaryFolder folder;
  ScalarGrid field("sigma", {0.5}, kUnknown, {{0, 0, 0}, {8, 0, 0}});
  field.leaf(0).at(1, 2, 3) = 0.0f, field.leaf(1).at(4, 5, 6) = -2.5f;
  writeGrids(folder / "f.vdb", {&field});
  const ScalarGrid back = readGrid(folder / "f.vdb");
  EXPECT_EQ(back.at({1, 2, 3}), 0.0f);
  EXPECT_EQ(back.at({12, 5, 6}), -2.5f);
  EXPECT_TRUE(std::isnan(back.at({1, 2, 4})));
  EXPECT_TRUE(std::isnan(back.at({100, 0, 0})));
  // Other tools see no number that is none.
  openvdb::io::File file((folder / "f.vdb").string());
  file.open();
  const auto plain = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("sigma"));
  EXPECT_EQ(plain->background(), 0.0f);
  EXPECT_EQ(plain->activeVoxelCount(), 2u);
}

TEST(GridFile, PlainOpenVdbSeesWhatAFieldIs) {
  const TemporaryFolder folder;
  const ScalarGrid field = someField();
  writeGrids(folder / "g.vdb", {&field});
  const auto grid = openPlainly(folder / "g.vdb", "rho");
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_UNKNOWN);
  EXPECT_EQ(grid->getCreator(), "vdbfuse");
  EXPECT_EQ(grid->metaValue<std::string>("about"), "a test");
  EXPECT_EQ(grid->activeVoxelCount(), 2u);
  EXPECT_EQ(grid->indexToWorld(openvdb::Coord(1, 2, 3)), openvdb::Vec3d(1.25, -1.5, 3.75));
  EXPECT_TRUE(grid->tree().isValueOn(openvdb::Coord(1, 2, 3)));
  EXPECT_FALSE(grid->tree().isValueOn(openvdb::Coord(0, 0, 0)));
}

TEST(GridFile, PlainOpenVdbSeesALevelSetWithUniformVoxelsAndAFiniteBackground) {
  const TemporaryFolder folder;
  const ScalarGrid surface = someLevelSet();
  writeGrids(folder / "g.vdb", {&surface});
  const auto grid = openPlainly(folder / "g.vdb", "surface");
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_TRUE(grid->hasUniformVoxels());
  EXPECT_EQ(grid->background(), 0.5f);
  EXPECT_EQ(grid->activeVoxelCount(), 3u);
  EXPECT_EQ(grid->tree().leafCount(), 1u);
  for (auto value = grid->cbeginValueAll(); value; ++value) EXPECT_TRUE(std::isfinite(*value));
}

TEST(GridFile, AFailureLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const ScalarGrid field = someField();
  const std::string message = messageOf<IoError>([&] { writeGrids(folder / "no/g.vdb", {&field}); });
  EXPECT_THAT(message, testing::StartsWith((folder / "no/g.vdb").string() + ": cannot be written: "));
  EXPECT_EQ(folder.entryCount(), 0u);
  std::filesystem::create_directories(folder / "taken.vdb/inside");
  EXPECT_THROW(writeGrids(folder / "taken.vdb", {&field}), IoError);
  EXPECT_TRUE(std::filesystem::exists(folder / "taken.vdb/inside"));
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(GridFile, WhatIsMissingIsSaid) {
  const TemporaryFolder folder;
  const ScalarGrid field = someField();
  writeGrids(folder / "g.vdb", {&field});
  EXPECT_EQ(messageOf<IoError>([&] { readGrid(folder / "g.vdb", "sigma"); }),
            (folder / "g.vdb").string() + ": expected a float grid named 'sigma', found none");
  test::writeText(folder / "bad.vdb", "this is no grid");
  EXPECT_THAT(messageOf<IoError>([&] { readGrid(folder / "bad.vdb"); }),
              testing::StartsWith((folder / "bad.vdb").string() + ": cannot be read: "));
  EXPECT_THROW(readGrid(folder / "none.vdb"), IoError);
}

TEST(GridFile, AGridOfAnotherTypeOrWithStretchedVoxelsIsRefused) {
  openvdb::initialize();
  const TemporaryFolder folder;
  const auto write = [&](const openvdb::GridBase::Ptr& grid) {
    openvdb::io::File(folder.path() / "o.vdb").write({grid});
  };
  const auto ints = openvdb::Int32Grid::create();
  ints->setName("ints");
  write(ints);
  EXPECT_THAT(messageOf<IoError>([&] { readGrid(folder / "o.vdb"); }),
              testing::EndsWith("expected a float grid, found a grid of type int32"));
  const auto stretched = openvdb::FloatGrid::create();
  const auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  transform->preScale(openvdb::Vec3d(1, 2, 1));
  stretched->setTransform(transform);
  write(stretched);
  EXPECT_THAT(messageOf<IoError>([&] { readGrid(folder / "o.vdb"); }),
              testing::EndsWith("expected a grid with uniform voxels, found a transform that stretches"));
}

}  // namespace
}  // namespace vdbfuse
