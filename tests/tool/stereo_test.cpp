// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tool/run_tool.h"
#include "vdbfuse/formats/image_set.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/mesh/topology.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using testing::HasSubstr;

// Half of the diagonal of 1 over the square root of 3.
constexpr double kRadius = 0.2886751;

// A folder with `images`: photographs of a textured ball around the origin.
class StereoTool : public testing::Test {
 protected:
  void SetUp() override {
    const ToolResult run = runTool(folder,
                                   "synth sphere images --arc full --views 40 --size 96x72 --textured "
                                   "--images-only --quiet");
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }

  std::string complaint(const std::string& arguments) const { return complaintOf(folder, arguments); }

  TemporaryFolder folder;
};

// Share of the depths that lie on the ball within a tenth of its radius: most of a pixel.
double shareOnTheBall(const ViewSequence& views) {
  double on = 0, all = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const View view = views.load(i);
    for (int y = 0; y < view.map.depth.height(); ++y) {
      for (int x = 0; x < view.map.depth.width(); ++x) {
        if (view.map.depth(x, y) == kInvalidDepth || view.map.confidence(x, y) < 0.3F) continue;
        ++all;
        on += std::abs(worldPoint(view, x, y).norm() - kRadius) < 0.1 * kRadius ? 1 : 0;
      }
    }
  }
  return on / all;
}

TEST_F(StereoTool, WritesDepthMapsPreviewsAndWhatIsKnownOfThem) {
  const ToolResult run = runTool(folder, "stereo images depths --json times.json --threads 2");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\n40 depth maps, "));
  const DepthSet set = readDepthSet(folder / "depths");
  EXPECT_EQ(set.format, "mvsnet");
  ASSERT_EQ(set.views.size(), 40u);
  EXPECT_GT(shareOnTheBall(set.views), 0.9);
  // Photograph, depths and confidences beside each other.
  const Image<Rgb8> preview = readPngRgb(folder / "depths/preview/00000007.png");
  const View view = set.views.load(7);
  ASSERT_EQ(preview.width(), 3 * 96);
  EXPECT_EQ(preview(48, 36), view.map.color(48, 36));
  for (int y = 0; y < 72; ++y) {
    for (int x = 0; x < 96; ++x) {
      const bool is_black = preview(96 + x, y) == Rgb8{0, 0, 0};
      ASSERT_EQ(is_black, view.map.depth(x, y) == kInvalidDepth) << x << ", " << y;
    }
  }
  json found = json::parse(readText(folder / "times.json"));
  EXPECT_EQ(found["command"], "stereo");
  EXPECT_EQ(found["options"]["mode"], "fast");
  EXPECT_EQ(found["input"], json({{"photographs", 40}, {"width", 96}, {"height", 72}, {"format", "mvsnet"}}));
  const json& row = found["views"][7];
  EXPECT_EQ(row["name"], "00000007");
  EXPECT_GE(row["partners"].size(), 2u);
  EXPECT_LT(row["near"], row["far"]);
  EXPECT_GT(row["matching_error_px"], 0);
  EXPECT_GT(row["noise_quadratic"], 0);
  EXPECT_GT(row["mean_confidence"], 0.3);
  std::size_t pixels = 0;
  for (const float depth : view.map.depth) pixels += depth != kInvalidDepth ? 1 : 0;
  EXPECT_EQ(row["pixels_with_depth"], pixels);
  EXPECT_GT(found["steps"].size(), 0u);
  found.erase("steps"), found.erase("peak_memory_bytes");
  EXPECT_EQ(json::parse(readText(folder / "depths/stereo.json")), found);
}

TEST_F(StereoTool, WritesAWorkspaceOfColmapWithNamesAndMasks) {
  std::vector<Photograph> photographs;
  const ImageSet images = readImageSet(folder / "images");
  for (const std::size_t i : {0u, 1u, 2u, 3u, 4u, 5u}) {
    photographs.push_back(images.photographs.load(i));
    photographs.back().name = "picture" + std::to_string(i);
  }
  photographs[2].mask = Image<std::uint8_t>(96, 72, std::uint8_t{255});
  photographs[2].mask(3, 4) = 0;
  writeImageSet(folder / "strecha", "strecha", PhotographSequence::fromPhotographs(photographs));
  for (const char* format : {"colmap", "mvsnet"}) {
    const ToolResult run = runTool(folder, "stereo strecha " + std::string(format) + " --to " + format);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("note: silhouette masks for 1 of 6 photographs\n"));
    EXPECT_TRUE(fs::exists(folder / format / "preview/picture2.png"));
    const DepthSet set = readDepthSet(folder / format);
    ASSERT_EQ(set.format, format);
    EXPECT_EQ(set.views.load(2).map.mask, photographs[2].mask);
    EXPECT_TRUE(set.views.load(1).map.mask.empty());
    EXPECT_TRUE(set.views.header(2).world_from_camera.isApprox(photographs[2].world_from_camera, 1e-9));
  }
  EXPECT_EQ(readDepthSet(folder / "colmap").views.header(2).name, "picture2");
}

TEST_F(StereoTool, LooksWhereItIsTold) {
  const ToolResult run =
      runTool(folder,
              "stereo images depths --views 8 --min-depth 1 --max-depth 1.6 --neighbours 2 "
              "--no-cross-check --surface-sweeps 0 --min-confidence 0.5 --max-angle 60 --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const json found = json::parse(readText(folder / "depths/stereo.json"));
  EXPECT_EQ(found["input"]["photographs"], 8);
  EXPECT_EQ(found["options"]["cross_check"], false);
  EXPECT_EQ(found["options"]["max_angle_deg"], 60);
  for (const json& row : found["views"]) {
    EXPECT_EQ(row["near"], 1.0);
    EXPECT_EQ(row["far"], 1.6);
    EXPECT_LE(row["partners"].size(), 2u);
  }
  const DepthSet set = readDepthSet(folder / "depths");
  for (const float confidence : set.views.load(0).map.confidence)
    ASSERT_TRUE(confidence == 0 || confidence >= 0.5F);
}

TEST_F(StereoTool, LeavesNothingBehindWhenItFails) {
  EXPECT_EQ(complaint("stereo nowhere depths"),
            "vdbfuse: nowhere: expected a set of photographs, found nothing of that name\n");
  EXPECT_EQ(complaint("stereo images depths --bbox 1,1,1,0,0,0"),
            "vdbfuse: --bbox: the lower corner must come first\n");
  EXPECT_EQ(complaint("stereo images . --overwrite"), "vdbfuse: OUTDIR: holds the input\n");
  test::writeText(folder / "kept.json", "precious");
  EXPECT_EQ(complaint("stereo images depths --json kept.json"),
            "vdbfuse: kept.json: exists already; give --overwrite to replace it\n");
  fs::create_directory(folder / "full");
  test::writeText(folder / "full/mine.txt", "precious");
  EXPECT_EQ(complaint("stereo images full"),
            "vdbfuse: full: expected an empty folder (or --overwrite), found one that is not empty\n");
}

TEST(Stereo, WrongUsageHasAnExitCodeOfItsOwn) {
  for (const char* wrong :
       {"", "x", "x y --mode best", "x y --window 4", "x y --hypotheses 5", "x y --to tum",
        "x y --min-angle 40 --max-angle 10", "x y --format rgbd", "x y --views 1"})
    EXPECT_EQ(runTool("stereo " + std::string(wrong)).exit_code, 2) << wrong;
  EXPECT_EQ(runTool("stereo --help").exit_code, 0);
}

TEST_F(StereoTool, FuseTakesPhotographs) {
  const ToolResult run = runTool(folder, "fuse images mesh.ply --resolution 48 --json fuse.json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const TriangleMesh mesh = readMesh(folder / "mesh.ply");
  EXPECT_EQ(topology(mesh).open_edges, 0u);
  double on = 0;
  for (const auto& vertex : mesh.vertices)
    on += std::abs(vertex.cast<double>().norm() - kRadius) < 0.03 ? 1 : 0;
  EXPECT_GT(on / static_cast<double>(mesh.vertices.size()), 0.9);
  EXPECT_EQ(mesh.colors.size(), mesh.vertices.size());
  const json found = json::parse(readText(folder / "fuse.json"));
  EXPECT_EQ(found["input"]["views"], 40);
  EXPECT_EQ(found["stereo"]["views"].size(), 40u);
  EXPECT_EQ(found["steps"][0]["name"], "match");
  // The matching says how large the noise is, unless it is told.
  EXPECT_EQ(found["calibration"]["noise_law"], "given");
  const ToolResult told = runTool(
      folder,
      "fuse images told.ply --resolution 32 --noise-scale 0.01 --json told.json --quiet --from-images");
  ASSERT_EQ(told.exit_code, 0) << told.err;
  const json calibration = json::parse(readText(folder / "told.json"))["calibration"];
  EXPECT_NEAR(calibration["noise_scale"], 0.01, 1e-9);
}

TEST_F(StereoTool, FuseRefusesOptionsOfTheOtherKindOfInput) {
  EXPECT_EQ(complaint("fuse images mesh.ply --depth-scale 2"),
            "vdbfuse: --depth-scale: the input is photographs, which hold no depths\n");
  ASSERT_EQ(runTool(folder, "stereo images depths --quiet --views 6").exit_code, 0);
  EXPECT_EQ(complaint("fuse depths mesh.ply --neighbours 3"),
            "vdbfuse: --neighbours: the input is depth maps, which are matched already\n");
}

}  // namespace
}  // namespace vdbfuse
