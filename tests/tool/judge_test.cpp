// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fusion/scenes.h"
#include "tool/run_tool.h"
#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using test::writeText;
using testing::HasSubstr;

// A folder with `scan`, a noisy sphere in the layout of MVSNet.
class JudgeTool : public testing::Test {
 protected:
  void SetUp() override {
    std::vector<View> views = test::sphereViews(16, 48);
    test::addNoise(views, {0.004, 0, 0}, 1);
    MvsnetWriter writer(folder / "scan");
    for (const View& view : views) writer.add(view);
  }

  std::string complaint(const std::string& arguments) const { return complaintOf(folder, arguments); }

  TemporaryFolder folder;
};

TEST_F(JudgeTool, WritesAFolderThatFuseTakesInPlaceOfJudgingAgain) {
  const ToolResult judged = runTool(folder, "judge scan judged --json judge.json --threads 2");
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  EXPECT_EQ(judged.out, readText(folder / "judged/judgement.txt"));
  EXPECT_EQ(readPngGrey8(folder / "judged/00000003.png").width(), 48);
  const auto json = nlohmann::json::parse(readText(folder / "judge.json"));
  EXPECT_EQ(json["command"], "judge");
  EXPECT_EQ(json["steps"][2]["name"], "judge");
  auto kept = json;
  kept.erase("steps"), kept.erase("peak_memory_bytes");
  EXPECT_EQ(kept, nlohmann::json::parse(readText(folder / "judged/judgement.json")));

  ASSERT_EQ(runTool(folder, "fuse scan direct.ply --resolution 32").exit_code, 0);
  const ToolResult fused =
      runTool(folder, "fuse scan handed.ply --resolution 32 --judgement judged --json fuse.json");
  ASSERT_EQ(fused.exit_code, 0) << fused.err;
  EvaluateOptions options;
  options.samples = 2000, options.iou_resolution = 64;
  const TriangleMesh direct = readMesh(folder / "direct.ply"), handed = readMesh(folder / "handed.ply");
  EXPECT_GT(evaluate(handed, direct, options).iou.value_or(0), 0.999);
  const auto fuse = nlohmann::json::parse(readText(folder / "fuse.json"));
  EXPECT_EQ(fuse["options"]["judgement"], "judged");
  EXPECT_EQ(fuse["calibration"], json["calibration"]);
  EXPECT_EQ(fuse["steps"][2]["name"], "read judgement");
}

TEST_F(JudgeTool, IsTheSameForOneAndTwoThreads) {
  ASSERT_EQ(runTool(folder, "judge scan one --threads 1 --quiet").exit_code, 0);
  ASSERT_EQ(runTool(folder, "judge scan two --threads 2 --quiet").exit_code, 0);
  for (const char* file : {"judgement.json", "judgement.txt", "00000007.png", "outliers/00000007.png"})
    EXPECT_EQ(readText(folder / "one" / file), readText(folder / "two" / file)) << file;
}

TEST_F(JudgeTool, KeepsWhatIsThereUnlessToldOtherwise) {
  std::filesystem::create_directory(folder / "judged");
  writeText(folder / "judged/mine", "x");
  EXPECT_EQ(complaint("judge scan judged"),
            "vdbfuse: judged: expected an empty folder (or --overwrite), found one that is not empty\n");
  writeText(folder / "judge.json", "x");
  EXPECT_EQ(complaint("judge scan other --json judge.json"),
            "vdbfuse: judge.json: exists already; give --overwrite to replace it\n");
  EXPECT_EQ(runTool(folder, "judge scan judged --json judge.json --overwrite --quiet").exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "judged/mine"));
}

TEST_F(JudgeTool, NeverReplacesItsInput) {
  for (const char* output : {"scan", "./scan/", "."})
    EXPECT_EQ(complaint("judge scan " + std::string(output) + " --overwrite"),
              "vdbfuse: OUTDIR: holds the input\n");
  EXPECT_TRUE(std::filesystem::exists(folder / "scan/cams"));
}

TEST_F(JudgeTool, LeavesNothingBehindWhenAViewIsDamaged) {
  writeText(folder / "scan/depth_est/00000009.pfm", "Pf\n48 48\n-1\n");
  EXPECT_THAT(complaint("judge scan judged --json judge.json"), HasSubstr("00000009.pfm"));
}

TEST_F(JudgeTool, AJudgementThatDoesNotFitStopsFuse) {
  ASSERT_EQ(runTool(folder, "judge scan judged --quiet").exit_code, 0);
  EXPECT_EQ(complaint("fuse scan out.ply --judgement judged --views 8"),
            "vdbfuse: judged/judgement.json: expected a judgement of 8 views, found one of 16\n");
  EXPECT_EQ(complaint("fuse scan out.ply --judgement nowhere"),
            "vdbfuse: nowhere/judgement.json: expected a judgement, found nothing of that name\n");
  for (const char* option :
       {"--noise gaussian", "--noise-scale 1", "--outliers 0.1", "--no-reliability", "--no-return free"})
    EXPECT_EQ(runTool(folder, "fuse scan out.ply --judgement judged " + std::string(option)).exit_code, 2)
        << option;
}

TEST_F(JudgeTool, SilhouettesAreTakenFromTheFolderNamed) {
  std::filesystem::create_directory(folder / "masks");
  for (int i = 0; i < 16; ++i) {
    Image<std::uint8_t> mask(48, 48, std::uint8_t{255});
    for (int y = 0; y < 48; ++y)
      for (int x = 0; x < 12; ++x) mask(x, y) = 0;
    writePng(folder / ("masks/000000" + std::string(i < 10 ? "0" : "") + std::to_string(i) + ".png"), mask);
  }
  const ToolResult run = runTool(folder, "judge scan judged --masks masks");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("note: silhouette masks for 16 of 16 views\n"));
  const auto json = nlohmann::json::parse(readText(folder / "judged/judgement.json"));
  EXPECT_EQ(json["views"][0]["outside_mask"], 0.25);
  writePng(folder / "masks/00000005.png", Image<std::uint8_t>(40, 48));
  EXPECT_THAT(complaint("judge scan other --masks masks"),
              HasSubstr("masks/00000005.png: expected a mask of 48x48 pixels as the depth map, found 40x48"));
}

}  // namespace
}  // namespace vdbfuse
