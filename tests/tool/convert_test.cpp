// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "formats/tiny_scene.h"
#include "io/temporary_folder.h"
#include "tool/run_tool.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/fusion/conventions.h"

namespace vdbfuse {
namespace {

using test::quoted;
using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using testing::HasSubstr;

void writeScan(const std::filesystem::path& folder, const std::string& convention = "as-read") {
  const ViewSequence views = ViewSequence::fromViews(test::tinyViews(6));
  writeDepthSet(folder, "mvsnet", underConvention(views, {}, *conventionNamed(convention)));
}

TEST(Convert, WritesAnotherFormat) {
  const TemporaryFolder folder;
  writeScan(folder / "scan");
  const ToolResult run =
      runTool("convert " + quoted(folder / "scan") + " " + quoted(folder / "out") + " --to tum --quiet");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const DepthSet set = readDepthSet(folder / "out");
  EXPECT_EQ(set.format, "tum");
  test::expectSameViews(set.views, test::tinyViews(6), 0.000101);
}

TEST(Convert, SaysWhichStepOtherReadersMustBeTold) {
  const TemporaryFolder folder;
  writeScan(folder / "scan");
  const ToolResult run = runTool("convert " + quoted(folder / "scan") + " " + quoted(folder / "out") +
                                 " --to rgbd --step 0.0001 --views 2");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err,
              HasSubstr("note: rgbd has no place for the step; tell its readers (--depth-scale 0.0001)"));
  ReadOptions options;
  options.depth_scale = 0.0001;
  test::expectSameViews(readDepthSet(folder / "out", options).views, test::tinyViews(2), 0.0000501);
}

TEST(Convert, LeavesNothingBehindWhenItFails) {
  const TemporaryFolder folder;
  writeScan(folder / "scan");
  const std::string arguments = "convert " + quoted(folder / "scan") + " " + quoted(folder / "out");
  EXPECT_EQ(runTool(arguments + " --to rgbd --step 1e-6").exit_code, 1);
  EXPECT_EQ(folder.entryCount(), 1u);
  EXPECT_EQ(runTool(arguments + " --to e57").exit_code, 2);
  EXPECT_EQ(runTool(arguments).exit_code, 2);
  const ToolResult itself =
      runTool("convert " + quoted(folder / "scan") + " " + quoted(folder.path()) + " --to tum --overwrite");
  EXPECT_EQ(itself.exit_code, 1);
  EXPECT_EQ(itself.err, "vdbfuse: OUTDIR: holds the input\n");
  EXPECT_TRUE(std::filesystem::exists(folder / "scan"));
}

TEST(Info, WarnsOfAWrongConventionAndNamesTheRightOne) {
  const TemporaryFolder folder;
  writeScan(folder / "scan", "inverse");
  const ToolResult run =
      runTool("info " + quoted(folder / "scan") + " --json " + quoted(folder / "info.json"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("warning: the views disagree with each other"));
  EXPECT_THAT(run.err, HasSubstr("poses are camera_from_world"));
  EXPECT_THAT(run.err, HasSubstr("Try --fix-convention inverse\n"));
  const auto json = nlohmann::json::parse(readText(folder / "info.json"));
  EXPECT_EQ(json["conventions"]["better"]["convention"], "inverse");
  EXPECT_GT(json["conventions"]["better"]["agreement"], 0.8);
  EXPECT_EQ(json["reading"]["kind"], "z");
}

TEST(Fuse, WarnsOfAWrongConventionBeforeItBegins) {
  const TemporaryFolder folder;
  writeScan(folder / "scan", "inverse");
  const std::string arguments = quoted(folder / "scan") + " " + quoted(folder / "mesh.ply");
  EXPECT_THAT(runTool("fuse " + arguments).err, HasSubstr("Try --fix-convention inverse\n"));
  EXPECT_THAT(runTool("fuse " + arguments + " --overwrite --fix-convention auto").err,
              testing::AllOf(HasSubstr("note: taken as inverse"), testing::Not(HasSubstr("warning"))));
}

TEST(Info, FixesTheConventionWhenAskedTo) {
  const TemporaryFolder folder;
  writeScan(folder / "scan", "inverse");
  for (const char* fix : {"auto", "inverse"}) {
    const ToolResult run =
        runTool("info " + quoted(folder / "scan") + " --fix-convention " + std::string(fix));
    EXPECT_EQ(run.err, "");
    EXPECT_THAT(run.out, HasSubstr("note        taken as inverse: poses are camera_from_world"));
  }
  EXPECT_EQ(runTool("info x --fix-convention sideways").exit_code, 2);
  writeScan(folder / "right");
  EXPECT_THAT(runTool("info " + quoted(folder / "right") + " --fix-convention auto").out,
              testing::Not(HasSubstr("taken as")));
}

TEST(Info, DataSetsWithoutAnyDepthAreRefused) {
  const TemporaryFolder folder;
  std::vector<View> views = test::tinyViews(2);
  for (View& view : views) view.map.depth = Image<float>(24, 18, kInvalidDepth);
  writeDepthSet(folder / "scan", "mvsnet", ViewSequence::fromViews(views));
  const ToolResult run = runTool("info " + quoted(folder / "scan"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.err, "vdbfuse: " + (folder / "scan").string() +
                         ": expected depth maps that hold depths, found none valid in any of them\n");
  EXPECT_EQ(runTool("fuse " + quoted(folder / "scan") + " " + quoted(folder / "mesh.ply")).exit_code, 1);
}

TEST(Formats, SayForAPathWhatEachMisses) {
  const TemporaryFolder folder;
  writeScan(folder / "scan");
  const ToolResult run = runTool("formats " + quoted(folder / "scan"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("mvsnet       yes     6 depth maps with cameras\n"));
  EXPECT_THAT(run.out, HasSubstr("rgbd         no      no *.depth.png\n"));
  EXPECT_EQ(runTool("formats " + quoted(folder / "none")).exit_code, 1);
}

}  // namespace
}  // namespace vdbfuse
