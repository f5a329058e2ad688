// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/temporary_folder.h"
#include "tool/run_tool.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/io/pfm.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using test::writeText;
using testing::HasSubstr;

const std::string kSmall = " --views 3 --size 64x48";

TEST(Synth, WritesAScanThatCanBeReadWithItsTruthAndItsStory) {
  const TemporaryFolder folder;
  const ToolResult run = runTool(folder, "synth sphere scan --hard --oracle" + kSmall);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 views 64x48 of sphere"));
  const DepthSet set = readDepthSet(folder / "scan");
  EXPECT_EQ(set.format, "mvsnet");
  ASSERT_EQ(set.views.size(), 3u);
  EXPECT_FALSE(set.views.load(2).map.confidence.empty());
  EXPECT_TRUE(isClosedManifold(topology(readMesh(folder / "scan/truth.ply"))));
  EXPECT_EQ(readPngGrey8(folder / "scan/wrong/00000002.png").width(), 64);
  const auto story = nlohmann::json::parse(readText(folder / "scan/scene.json"));
  EXPECT_EQ(story["options"]["confidence"], "overlapping");
  EXPECT_EQ(story["options"]["outliers"], 0.08);
  EXPECT_EQ(story["regions"][0]["shape"], "sphere");
  EXPECT_EQ(story["regions"][0]["expect"], "inside");
}

TEST(Synth, WhatIsGivenWinsOverWhatHardStandsFor) {
  const TemporaryFolder folder;
  const std::string options = " --hard --outliers 0.2 --confidence none";
  ASSERT_EQ(runTool(folder, "synth box scan --quiet" + options + kSmall).exit_code, 0);
  const auto story = nlohmann::json::parse(readText(folder / "scan/scene.json"));
  EXPECT_EQ(story["options"]["outliers"], 0.2);
  EXPECT_FALSE(fs::exists(folder / "scan/confidence"));
}

TEST(Synth, WritesTheSameBytesForOneThreadAndTwo) {
  const TemporaryFolder folder;
  for (const std::string threads : {"1", "2"})
    ASSERT_EQ(runTool(folder, "synth torus " + threads + " --hard --threads " + threads + kSmall).exit_code,
              0);
  for (const std::string file : {"depth_est/00000001.pfm", "confidence/00000001.pfm", "cams/00000001_cam.txt",
                                 "truth.ply", "scene.json"})
    EXPECT_EQ(readText(folder / ("1/" + file)), readText(folder / ("2/" + file))) << file;
}

TEST(Synth, PicturesComeWithTheDepthMapsOrAlone) {
  const TemporaryFolder folder;
  const std::string options = " --textured --gain 1.2 --bias 3 --image-noise 2 --gloss 0.2 --true-depth";
  ASSERT_EQ(runTool(folder, "synth sphere both" + options + kSmall).exit_code, 0);
  ASSERT_EQ(runTool(folder, "synth sphere alone --images-only" + options + kSmall).exit_code, 0);
  const View view = readDepthSet(folder / "both").views.load(1);
  EXPECT_EQ(view.map.color.width(), 64);
  EXPECT_EQ(view.map.color, readPngRgb(folder / "alone/images/00000001.png"));
  EXPECT_FALSE(fs::exists(folder / "alone/depth_est"));
  EXPECT_FALSE(fs::exists(folder / "alone/confidence"));
  EXPECT_THAT(readText(folder / "alone/cams/00000001_cam.txt"), testing::EndsWith(" 192 2.1\n"));
  const Image<float> truth = readPfm(folder / "alone/true_depth/00000001.pfm");
  EXPECT_EQ(truth, readPfm(folder / "both/true_depth/00000001.pfm"));
  EXPECT_NEAR(truth(32, 24), view.map.depth(32, 24), 0.02);
  const auto story = nlohmann::json::parse(readText(folder / "alone/scene.json"));
  EXPECT_EQ(story["options"]["photographs"]["gain"], 1.2);
}

TEST(Synth, RefusesAFolderThatIsNotEmptyAndReplacesItWhenTold) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "scan");
  writeText(folder / "scan/mine.txt", "precious");
  const ToolResult refused = runTool(folder, "synth sphere scan" + kSmall);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err,
              HasSubstr("expected an empty folder (or --overwrite), found one that is not empty"));
  EXPECT_EQ(readText(folder / "scan/mine.txt"), "precious");
  EXPECT_EQ(runTool(folder, "synth sphere scan --overwrite" + kSmall).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "scan/mine.txt"));
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(Synth, LeavesNothingBehindWhenTheSceneCannotBeRead) {
  const TemporaryFolder folder;
  const ToolResult unknown = runTool(folder, "synth teapot scan");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_THAT(unknown.err,
              HasSubstr("'teapot' is neither sphere, box, torus, figure, occluder, ball nor a mesh file"));
  writeText(folder / "broken.ply", "ply\n");
  EXPECT_EQ(runTool(folder, "synth broken.ply scan").exit_code, 1);
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(Synth, SaysWhatIsWrongWithItsOptions) {
  const TemporaryFolder folder;
  const auto words = [&](const std::string& options) {
    const ToolResult run = runTool(folder, "synth sphere scan " + options);
    EXPECT_EQ(run.exit_code, 2) << options;
    return run.err;
  };
  EXPECT_THAT(words("--size 64"), HasSubstr("--size: expected WIDTHxHEIGHT, found '64'"));
  EXPECT_THAT(words("--arc moon"), HasSubstr("--arc: 'moon' is none of front, full, ring, room, upper"));
  EXPECT_THAT(words("--views 0 --missing 2"),
              HasSubstr("views must be positive; the share of missing pixels must lie in [0, 1]"));
  EXPECT_THAT(words("--images-only"), HasSubstr("--images-only requires --textured"));
  EXPECT_THAT(words("--textured --gain 0.5"), HasSubstr("the gain must be at least 1"));
  EXPECT_EQ(folder.entryCount(), 0u);
}

}  // namespace
}  // namespace vdbfuse
