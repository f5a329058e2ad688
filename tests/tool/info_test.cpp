// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "io/temporary_folder.h"
#include "tool/run_tool.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/image_set.h"
#include "vdbfuse/formats/mvsnet.h"

namespace vdbfuse {
namespace {

using test::quoted;
using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using test::writeText;
using testing::HasSubstr;

// Two cameras a unit apart, both with a wall two units ahead.
void writeScan(const std::filesystem::path& folder) {
  MvsnetWriter writer(folder);
  for (int i = 0; i < 2; ++i) {
    View view;
    view.projection = Pinhole{8, 6, 8, 8, 3.5, 2.5, {}};
    view.world_from_camera.translation() = Eigen::Vector3d(i, 0, 0);
    view.map.depth = Image<float>(8, 6, 2.0f);
    for (int y = 0; y < 6; ++y) view.map.depth(0, y) = kInvalidDepth;
    writer.add(view);
  }
}

TEST(Info, TellsWhatIsInADataSet) {
  const TemporaryFolder folder;
  writeScan(folder / "scan");
  const ToolResult run = runTool("info " + quoted(folder / "scan"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(run.out,
            "format      mvsnet\n"
            "views       2, 8x6 pixels\n"
            "stored      32-bit float PFM, z; invalid: 0, negative, not finite\n"
            "poses       4x4 camera_from_world ('extrinsic'), x right, y down, z forward\n"
            "coverage    87.5 % of the pixels have a depth\n"
            "depth       2 to 2, median 2 (smallest 2, largest 2)\n"
            "confidence  none\n"
            "colour      0 views\n"
            "points      -0.625,-0.625,2 to 1.875,0.625,2\n"
            "cameras     0,0,0 to 1,0,0\n"
            "agreement   96 % of the points lie where other views see a surface\n");
}

TEST(Info, JsonHoldsTheSame) {
  const TemporaryFolder folder;
  writeScan(folder / "scan");
  const std::filesystem::path file = folder / "info.json";
  const std::string arguments = "info " + quoted(folder / "scan") + " --json " + quoted(file);
  EXPECT_EQ(runTool(arguments + " --depth-scale 3").exit_code, 0);
  const nlohmann::json json = nlohmann::json::parse(readText(file));
  EXPECT_EQ(json["command"], "info");
  EXPECT_EQ(json["input"], nlohmann::json({{"views", 2}, {"width", 8}, {"height", 6}, {"format", "mvsnet"}}));
  EXPECT_EQ(json["options"]["depth_scale"], 3.0);
  EXPECT_EQ(json["depth"]["median"], 6.0);
  EXPECT_EQ(json["coverage"], 0.875);
  EXPECT_EQ(json["confidence"], nullptr);
  EXPECT_EQ(json["cameras"]["max"], nlohmann::json({1.0, 0.0, 0.0}));
  // What is there stays there unless told otherwise.
  const ToolResult again = runTool(arguments);
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_EQ(again.err, "vdbfuse: " + file.string() + ": exists already; give --overwrite to replace it\n");
  EXPECT_EQ(runTool(arguments + " --overwrite").exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(readText(file))["depth"]["median"], 2.0);
}

// Two photographs, of one of which the depths are known.
void writePhotographs(const std::filesystem::path& folder) {
  std::vector<Photograph> photographs(2);
  for (int i = 0; i < 2; ++i) {
    Photograph& photograph = photographs[static_cast<std::size_t>(i)];
    photograph.name = std::to_string(i);
    photograph.camera = {8, 6, 8, 8, 3.5, 2.5, {}};
    photograph.world_from_camera.translation() = Eigen::Vector3d(i, 0, 0);
    photograph.brightness = Image<float>(8, 6, 0.5F);
  }
  photographs[1].depth = DepthInterval{1, 3};
  writeImageSet(folder, "mvsnet", PhotographSequence::fromPhotographs(std::move(photographs)));
}

TEST(Info, TellsWhatPhotographsAreThere) {
  const TemporaryFolder folder;
  writePhotographs(folder / "images");
  const ToolResult run =
      runTool("info " + quoted(folder / "images") + " --json " + quoted(folder / "info.json"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(run.out,
            "format      mvsnet\n"
            "photographs 2, 8x6 pixels\n"
            "poses       4x4 camera_from_world ('extrinsic'), x right, y down, z forward\n"
            "depths      1 to 3, stated of 1 photographs\n"
            "cameras     0,0,0 to 1,0,0\n");
  const nlohmann::json json = nlohmann::json::parse(readText(folder / "info.json"));
  EXPECT_EQ(json["input"],
            nlohmann::json({{"photographs", 2}, {"width", 8}, {"height", 6}, {"format", "mvsnet"}}));
  EXPECT_EQ(json["photographs"][0]["near"], nullptr);
  EXPECT_EQ(json["photographs"][1]["far"], 3.0);
}

TEST(Info, BadInputIsOneLineAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  writeScan(folder / "scan");
  writeText(folder / "scan/depth_est/00000001.pfm", "Pf\n8 6\n-1\n");
  const ToolResult run =
      runTool("info " + quoted(folder / "scan") + " --json " + quoted(folder / "info.json"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err, "vdbfuse: " + (folder / "scan/depth_est/00000001.pfm").string() +
                         ": byte 10: expected 202 bytes for 8x6 pixels, found the end of the file\n");
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(Info, WrongUsageHasAnExitCodeOfItsOwn) {
  EXPECT_EQ(runTool("info").exit_code, 2);
  EXPECT_EQ(runTool("info x --depth-kind wrong").exit_code, 2);
  EXPECT_EQ(runTool("info x --depth-scale -1").exit_code, 2);
  EXPECT_EQ(runTool("info x --format wrong").exit_code, 2);
  EXPECT_EQ(runTool("info --help").exit_code, 0);
}

TEST(Formats, AreAllListedWithTheirLayout) {
  const ToolResult run = runTool("formats");
  EXPECT_EQ(run.exit_code, 0);
  for (const DepthSetFormat& format : depthSetFormats()) {
    const std::string first_line(format.layout.substr(0, format.layout.find('\n')));
    EXPECT_THAT(run.out, HasSubstr(std::string(format.name) + ": " + std::string(format.description)));
    EXPECT_THAT(run.out, HasSubstr("    " + first_line + "\n"));
  }
  const std::string photographs = run.out.substr(run.out.find("\nPhotographs with cameras"));
  for (const ImageSetFormat& format : imageSetFormats())
    EXPECT_THAT(photographs,
                HasSubstr("\n" + std::string(format.name) + ": " + std::string(format.description)));
}

TEST(Formats, AreComparedWithAFolderOfPhotographs) {
  const TemporaryFolder folder;
  writePhotographs(folder / "images");
  const ToolResult run = runTool("formats " + quoted(folder / "images"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("Depth maps\nrgbd "));
  EXPECT_THAT(run.out, HasSubstr("mvsnet       no      cams/*_cam.txt, but no depth_est/*.pfm\n"));
  EXPECT_THAT(run.out, HasSubstr("mvsnet       yes     2 cameras and images/\n"));
}

}  // namespace
}  // namespace vdbfuse
