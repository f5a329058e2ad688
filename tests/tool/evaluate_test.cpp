// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "mesh/shapes.h"
#include "tool/run_tool.h"
#include "vdbfuse/io/mesh_file.h"

namespace vdbfuse {
namespace {

using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using testing::HasSubstr;

class EvaluateTool : public testing::Test {
 protected:
  void SetUp() override {
    writeMesh(folder / "truth.ply", test::sphere(1.0, 4));
    writeMesh(folder / "mesh.stl", test::sphere(1.05, 4));
  }
  TemporaryFolder folder;
};

TEST_F(EvaluateTool, WritesTheFrozenKeys) {
  test::writeText(folder / "regions.json",
                  R"({"regions": [{"name": "core", "expect": "inside", "shape": "sphere", "center": [0, 0, 0],
                      "radius": 0.5}]})");
  const ToolResult result =
      runTool(folder, "evaluate --tau 0.01,0.1 mesh.stl truth.ply --regions regions.json --json out.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(result.out, HasSubstr("region        core: 100.00 % kept"));
  EXPECT_THAT(result.out, HasSubstr("closed manifold"));
  const auto json = nlohmann::json::parse(test::readText(folder / "out.json"));
  EXPECT_NEAR(json.at("accuracy90").get<double>(), 0.05, 0.005);
  EXPECT_NEAR(json.at("accuracy_rms").get<double>(), 0.05, 0.005);
  EXPECT_EQ(json.at("completeness"), 0.0);
  EXPECT_EQ(json.at("fscore"), nlohmann::json({0.0, 1.0}));
  EXPECT_EQ(json.at("precision").size(), 2u);
  EXPECT_EQ(json.at("recall").size(), 2u);
  EXPECT_NEAR(json.at("iou").get<double>(), 1 / (1.05 * 1.05 * 1.05), 0.005);
  EXPECT_EQ(json.at("components"), 1);
  EXPECT_EQ(json.at("open_edges"), 0);
  EXPECT_EQ(json.at("nonmanifold_edges"), 0);
  EXPECT_EQ(json.at("regions").at("core"), 1.0);
}

TEST_F(EvaluateTool, SaysWhatVolumeIsWrongDeeperThanAsked) {
  const ToolResult result = runTool(folder, "evaluate mesh.stl truth.ply --deep 0.02 --json out.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("deep          0.000 % of the true volume lost, "));
  const auto json = nlohmann::json::parse(test::readText(folder / "out.json"));
  EXPECT_EQ(json.at("options").at("deep"), 0.02);
  EXPECT_EQ(json.at("false_outside_volume_deep"), 0.0);
  EXPECT_NEAR(json.at("false_inside_volume_deep").get<double>(), 1.05 * 1.05 * 1.05 - 1.02 * 1.02 * 1.02,
              0.005);
  EXPECT_EQ(runTool(folder, "evaluate mesh.stl truth.ply --deep -1").exit_code, 2);
  ASSERT_EQ(runTool(folder, "evaluate mesh.stl truth.ply --json out.json").exit_code, 0);
  EXPECT_FALSE(
      nlohmann::json::parse(test::readText(folder / "out.json")).contains("false_inside_volume_deep"));
}

TEST_F(EvaluateTool, SaysWhatIsWrongInOneLineAndExitsWithOne) {
  const ToolResult missing = runTool(folder, "evaluate none.ply truth.ply");
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_EQ(missing.err, "vdbfuse: none.ply: expected a file to read, found none\n");
  const ToolResult unwritable = runTool(folder, "evaluate mesh.stl truth.ply --json no/out.json");
  EXPECT_EQ(unwritable.exit_code, 1);
  EXPECT_THAT(unwritable.err,
              testing::StartsWith("vdbfuse: no/out.json: expected a folder that can be written to"));
  writeMesh(folder / "points.ply", {});
  const ToolResult empty = runTool(folder, "evaluate mesh.stl points.ply --json out.json");
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_EQ(empty.err, "vdbfuse: points.ply: expected a mesh with triangles, found none\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "out.json"));
}

TEST_F(EvaluateTool, WrongUsageExitsWithTwo) {
  EXPECT_EQ(runTool(folder, "evaluate mesh.stl").exit_code, 2);
  EXPECT_EQ(runTool(folder, "evaluate mesh.stl truth.ply --tau -1").exit_code, 2);
  EXPECT_EQ(runTool(folder, "evaluate mesh.stl truth.ply --tao 1").exit_code, 2);
}

TEST_F(EvaluateTool, AnEmptyMeshIsJudgedAndHasNoAccuracy) {
  writeMesh(folder / "empty.ply", {});
  EXPECT_EQ(runTool(folder, "evaluate empty.ply truth.ply --json out.json").exit_code, 0);
  const auto json = nlohmann::json::parse(test::readText(folder / "out.json"));
  EXPECT_TRUE(json.at("accuracy90").is_null());
  EXPECT_EQ(json.at("iou"), 0.0);
}

}  // namespace
}  // namespace vdbfuse
