// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/temporary_folder.h"
#include "mesh/shapes.h"
#include "tool/run_tool.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {
namespace {

using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using testing::HasSubstr;

TEST(RenderTool, FramesAMeshByItself) {
  const TemporaryFolder folder;
  writeMesh(folder / "ball.ply", test::sphere(3.0, 3, {7, 8, 9}));
  ASSERT_EQ(runTool(folder, "render ball.ply out.png --size 80x60").exit_code, 0);
  const Image<Rgb8> picture = readPngRgb(folder / "out.png");
  const Rgb8 white{255, 255, 255};
  EXPECT_EQ(picture.width(), 80);
  EXPECT_EQ(picture(0, 0), white);
  EXPECT_NE(picture(40, 30), white);
}

TEST(RenderTool, DrawsFromAViewOfADataSet) {
  const TemporaryFolder folder;
  ASSERT_EQ(runTool(folder, "synth sphere scan --views 2 --size 64x48").exit_code, 0);
  ASSERT_EQ(runTool(folder, "render scan/truth.ply a.png --from scan:1").exit_code, 0);
  EXPECT_EQ(readPngRgb(folder / "a.png").width(), 64);
  const ToolResult run = runTool(folder, "render scan/truth.ply b.png --from scan:7");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("no view '7' among 2"));
}

TEST(RenderTool, DrawsTheDistanceFromAReference) {
  const TemporaryFolder folder;
  writeMesh(folder / "small.ply", test::sphere(1.0, 3));
  writeMesh(folder / "large.ply", test::sphere(1.5, 3));
  const std::string options = " --size 40x30 --color error --range 0,0.5 --reference ";
  ASSERT_EQ(runTool(folder, "render small.ply none.png" + options + "small.ply").exit_code, 0);
  ASSERT_EQ(runTool(folder, "render small.ply much.png" + options + "large.ply").exit_code, 0);
  EXPECT_GT(readPngRgb(folder / "much.png")(20, 15)[0], readPngRgb(folder / "none.png")(20, 15)[0] + 80);
  EXPECT_EQ(runTool(folder, "render small.ply x.png --color error").exit_code, 2);
}

TEST(RenderTool, KeepsAnExistingPictureUnlessTold) {
  const TemporaryFolder folder;
  writeMesh(folder / "ball.ply", test::sphere(1.0, 2));
  test::writeText(folder / "out.png", "mine");
  const ToolResult run = runTool(folder, "render ball.ply out.png");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("or --overwrite"));
  EXPECT_EQ(readText(folder / "out.png"), "mine");
  EXPECT_EQ(runTool(folder, "render ball.ply out.png --overwrite --size 8x8").exit_code, 0);
}

TEST(RenderTool, SaysThatAMeshCarriesNoSupport) {
  const TemporaryFolder folder;
  writeMesh(folder / "ball.ply", test::sphere(1.0, 2));
  const ToolResult run = runTool(folder, "render ball.ply out.png --color support");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("the mesh carries no support"));
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(RenderTool, DrawsASliceOfAGridWithItsZeroLine) {
  const TemporaryFolder folder;
  ScalarGrid ball(
      "surface", {0.1}, 0.0f,
      {{-8, -8, -8}, {-8, -8, 0}, {-8, 0, -8}, {-8, 0, 0}, {0, -8, -8}, {0, -8, 0}, {0, 0, -8}, {0, 0, 0}});
  ball.forEachLeaf([&](const ScalarGrid::Leaf& leaf) {
    for (int k = 0; k < ScalarGrid::kLeafSize; ++k) {
      const Index3 voxel = leaf.origin + Index3(k >> 6, k >> 3 & 7, k & 7);
      leaf.values[static_cast<std::size_t>(k)] = static_cast<float>(0.1 * voxel.cast<double>().norm() - 0.45);
    }
  });
  writeGrids(folder / "ball.vdb", {&ball});
  ASSERT_EQ(runTool(folder, "render ball.vdb out.png --slice z=0 --size 64x64").exit_code, 0);
  const Image<Rgb8> picture = readPngRgb(folder / "out.png");
  ASSERT_EQ(picture.width(), 64);
  const Rgb8 inside = picture(32, 32), outside = picture(2, 2);
  EXPECT_GT(inside[0], inside[2]);    // red
  EXPECT_GT(outside[2], outside[0]);  // blue
}

TEST(RenderTool, DrawsTheCellsOfAllLevels) {
  const TemporaryFolder folder;
  ScalarGrid fine("sigma", {1.0}, kUnknown, {{0, 0, 0}});
  std::fill(fine.leaf(0).values.begin(), fine.leaf(0).values.end(), 1.0f);
  // Beside it one cell of eight voxels a side.
  ScalarGrid coarse("sigma_level3", {8.0, {3.5, 3.5, 3.5}}, kUnknown, {{0, 0, 0}});
  coarse.leaf(0).at(1, 0, 0) = 1.0f;
  writeGrids(folder / "g.vdb", {&fine, &coarse});
  const std::string slice = "render g.vdb out.png --slice z=4 --size 160x80 --overwrite";
  ASSERT_EQ(runTool(folder, slice).exit_code, 0);
  const Image<Rgb8> plain = readPngRgb(folder / "out.png");
  ASSERT_EQ(runTool(folder, slice + " --cells").exit_code, 0);
  const Image<Rgb8> picture = readPngRgb(folder / "out.png");
  const auto lines = [&](int begin, int end) {
    int count = 0;
    for (int x = begin; x < end; ++x) count += picture(x, 35) != plain(x, 35);
    return count;
  };
  EXPECT_EQ(lines(0, 80), 8);  // seven between eight voxels, and one to the coarse cell
  EXPECT_EQ(lines(80, 160), 0);
}

TEST(RenderTool, ASliceNeedsAPlaneAndAGridThatIsThere) {
  const TemporaryFolder folder;
  ScalarGrid grid("rho", {0.1}, 1.0f, {{0, 0, 0}});
  grid.leaf(0).values[0] = 0.5f;
  writeGrids(folder / "g.vdb", {&grid});
  const ToolResult without = runTool(folder, "render g.vdb out.png");
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_THAT(without.err, HasSubstr("--slice: is required to draw a grid"));
  const ToolResult wrong = runTool(folder, "render g.vdb out.png --slice w=3");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("expected x=VALUE, y=VALUE or z=VALUE, found 'w=3'"));
  const ToolResult missing = runTool(folder, "render g.vdb out.png --slice z=0 --grid sigma");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, HasSubstr("a float grid named 'sigma'"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out.png"));
}

}  // namespace
}  // namespace vdbfuse
