// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fusion/scenes.h"
#include "tool/run_tool.h"
#include "vdbfuse/formats/mvsnet.h"
#include "vdbfuse/fusion/tsdf.h"
#include "vdbfuse/io/mesh_file.h"
#include "vdbfuse/io/png.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using test::writeText;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

// A folder with `scan`, a noisy sphere in the layout of MVSNet.
class FuseTool : public testing::Test {
 protected:
  void SetUp() override { writeScan(test::sphereViews(16, 48)); }

  void writeScan(std::vector<View> views) const {
    test::addNoise(views, {0.004, 0, 0}, 1);
    MvsnetWriter writer(folder / "scan");
    for (const View& view : views) writer.add(view);
  }

  // The line without what stands before and behind it.
  std::string complaint(const std::string& arguments) const {
    const std::string line = complaintOf(folder, "fuse " + arguments);
    EXPECT_THAT(line, StartsWith("vdbfuse: "));
    EXPECT_THAT(line, EndsWith("\n"));
    return line.substr(9, line.size() - 10);
  }

  // Replaces `from` by `to` in a file of the scan.
  void edit(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = readText(folder / ("scan/" + file));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << text;
    writeText(folder / ("scan/" + file), text.replace(at, from.size(), to));
  }

  // Replaces the first row of the pose of camera 1.
  void setPoseRow(const std::string& row) const {
    std::string text = readText(folder / "scan/cams/00000001_cam.txt");
    const std::size_t begin = text.find('\n') + 1;
    writeText(folder / "scan/cams/00000001_cam.txt",
              text.replace(begin, text.find('\n', begin) - begin, row));
  }

  TemporaryFolder folder;
};

TEST_F(FuseTool, AVoxelThatNeedsTooMuchMemoryIsRefusedWithOneThatFits) {
  EXPECT_THAT(complaint("scan mesh.ply --voxel 0.00001 --memory 2GiB"),
              testing::AllOf(HasSubstr("voxel: 1e-05 needs about"), HasSubstr("2 GiB may be used"),
                             HasSubstr("would fit")));
}

TEST_F(FuseTool, MemoryHasAUnit) {
  for (const std::string size : {"500MiB", "0.5GiB", "0.5G", "5e8", "500 MB"}) {
    const ToolResult run = runTool(
        folder, "fuse scan mesh.ply --overwrite --resolution 30 --memory '" + size + "' --json out.json");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("may be used"));
    const auto json = nlohmann::json::parse(readText(folder / "out.json"));
    EXPECT_NEAR(json["memory"]["budget_bytes"].get<double>(), 5.2e8, 2.5e7) << size;
    EXPECT_GT(json["memory"]["estimated_bytes"].get<double>(), 1e7);
    EXPECT_EQ(json["memory"]["view_window_bytes"], 0);
  }
  for (const std::string size : {"much", "-1GiB", "5 elephants", "0"}) {
    const ToolResult run = runTool(folder, "fuse scan mesh.ply --overwrite --memory '" + size + "'");
    EXPECT_EQ(run.exit_code, 2) << size;
    EXPECT_THAT(run.err, HasSubstr("--memory"));
  }
}

TEST_F(FuseTool, FusesAScanIntoAClosedMeshAndSaysWhatItDid) {
  const ToolResult run =
      runTool(folder, "fuse scan out.ply --resolution 32 --json out.json --save-grids out.vdb");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith("out.ply: "));
  EXPECT_THAT(run.out, HasSubstr("(certified)"));
  const TriangleMesh mesh = readMesh(folder / "out.ply");
  EXPECT_TRUE(isClosedManifold(topology(mesh)));
  EXPECT_NEAR(signedVolume(mesh), 4.0 / 3 * M_PI * 0.125, 0.05);
  EXPECT_EQ(readGrid(folder / "out.vdb", "surface").frame().voxel,
            readGrid(folder / "out.vdb", "rho").frame().voxel);
  const auto json = nlohmann::json::parse(readText(folder / "out.json"));
  EXPECT_EQ(json.at("command"), "fuse");
  EXPECT_EQ(json.at("input").at("views"), 16);
  EXPECT_EQ(json.at("input").at("width"), 48);
  EXPECT_EQ(json.at("input").at("height"), 48);
  EXPECT_EQ(json.at("input").at("format"), "mvsnet");
  EXPECT_EQ(json.at("mesh").at("vertices"), mesh.vertices.size());
  EXPECT_EQ(json.at("mesh").at("open_edges"), 0);
  EXPECT_EQ(json.at("mesh").at("zero_area_triangles"), 0);
  EXPECT_GE(json.at("mesh").at("aspect_median"), 1);
  EXPECT_LT(json.at("mesh").at("aspect_99"), 100);  // marching cubes cuts corners
  EXPECT_EQ(json.at("cut").at("certified"), true);
  EXPECT_EQ(folder.entryCount(), 4u);
}

TEST_F(FuseTool, TheJsonHasTheFrozenKeys) {
  ASSERT_EQ(runTool(folder, "fuse scan out.ply --resolution 24 --json out.json --quiet").exit_code, 0);
  const auto json = nlohmann::json::parse(readText(folder / "out.json"));
  const std::map<std::string, std::vector<std::string>> keys = {
      {"options", {}},
      {"input", {"views", "width", "height", "format"}},
      {"calibration", {"noise_scale", "noise_law", "miss_rate", "outlier_share", "confidence_direction"}},
      {"grid", {"voxel", "active", "leaves", "cells", "levels"}},
      {"energy", {"total", "surface", "volume", "metric"}},
      {"cut", {"flow", "certified", "nodes", "arcs"}},
      {"mesh",
       {"vertices", "triangles", "components", "open_edges", "nonmanifold_edges", "invented_area_share"}}};
  for (const char* key : {"version", "command", "steps", "peak_memory_bytes"})
    EXPECT_TRUE(json.contains(key)) << key;
  for (const auto& [group, members] : keys) {
    ASSERT_TRUE(json.contains(group)) << group;
    for (const std::string& member : members)
      EXPECT_TRUE(json[group].contains(member)) << group << "." << member;
  }
  for (const auto& step : json["steps"])
    for (const char* key : {"name", "seconds", "cpu_seconds"}) EXPECT_TRUE(step.contains(key));
}

TEST_F(FuseTool, OneAndTwoThreadsWriteTheSameBytes) {
  for (const std::string method : {"visibility", "tsdf"}) {
    const std::string common = "fuse scan --resolution 32 --quiet --overwrite --method " + method;
    ASSERT_EQ(runTool(folder, common + " one.ply --threads 1").exit_code, 0);
    ASSERT_EQ(runTool(folder, common + " two.ply --threads 2").exit_code, 0);
    EXPECT_EQ(readText(folder / "one.ply"), readText(folder / "two.ply")) << method;
  }
}

TEST_F(FuseTool, AnExistingOutputKeepsItsBytesUnlessToldOtherwise) {
  writeText(folder / "out.ply", "precious");
  EXPECT_EQ(complaint("scan out.ply --resolution 24"),
            "out.ply: exists already; give --overwrite to replace it");
  EXPECT_EQ(readText(folder / "out.ply"), "precious");
  writeText(folder / "out.json", "precious, too");
  EXPECT_THAT(complaint("scan new.ply --resolution 24 --json out.json"),
              StartsWith("out.json: exists already"));
  EXPECT_EQ(readText(folder / "out.json"), "precious, too");
  // A failure with --overwrite leaves it, too.
  fs::remove(folder / "scan/cams/00000001_cam.txt");
  complaint("scan out.ply --overwrite");
  EXPECT_EQ(readText(folder / "out.ply"), "precious");
}

TEST_F(FuseTool, AMissingPoseIsNamed) {
  fs::remove(folder / "scan/cams/00000003_cam.txt");
  EXPECT_THAT(complaint("scan out.ply"), HasSubstr("00000003"));
}

TEST_F(FuseTool, APoseThatIsNoRotationOrNoNumberIsNamed) {
  setPoseRow("2 0 0 0");
  EXPECT_THAT(complaint("scan out.ply"),
              testing::AllOf(HasSubstr("scan/cams/00000001_cam.txt"), HasSubstr("rotation")));
  setPoseRow("nan 0 0 0");
  EXPECT_THAT(complaint("scan out.ply"), HasSubstr("scan/cams/00000001_cam.txt"));
  setPoseRow("1 0 0");
  EXPECT_THAT(complaint("scan out.ply"), HasSubstr("scan/cams/00000001_cam.txt"));
}

TEST_F(FuseTool, ATruncatedDepthMapIsNamedWithItsByte) {
  const fs::path file = folder / "scan/depth_est/00000002.pfm";
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_THAT(complaint("scan out.ply"), testing::AllOf(HasSubstr("scan/depth_est/00000002.pfm"),
                                                        HasSubstr("byte"), HasSubstr("expected")));
}

TEST_F(FuseTool, ATruncatedPngIsNamed) {
  fs::create_directory(folder / "rgbd");
  for (const std::string frame : {"a", "b"}) {
    writePng(folder / ("rgbd/" + frame + ".depth.png"), Image<std::uint16_t>(64, 48, std::uint16_t{1500}));
    writeText(folder / ("rgbd/" + frame + ".pose.txt"), "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  }
  writeText(folder / "rgbd/camera-intrinsics.txt", "50 0 31.5\n0 50 23.5\n0 0 1\n");
  const fs::path file = folder / "rgbd/b.depth.png";
  fs::resize_file(file, fs::file_size(file) - 20);
  EXPECT_THAT(complaint("rgbd out.ply"), HasSubstr("rgbd/b.depth.png"));
  fs::remove(folder / "rgbd/a.pose.txt");
  EXPECT_THAT(complaint("rgbd out.ply"), HasSubstr("a.pose.txt"));
}

TEST_F(FuseTool, NoViewsNoOverlapAndNoDepthAreErrors) {
  fs::create_directory(folder / "empty");
  EXPECT_THAT(complaint("empty out.ply"), StartsWith("empty: "));
  EXPECT_THAT(complaint("nothing out.ply"), StartsWith("nothing: "));
  fs::remove_all(folder / "scan");
  std::vector<View> views = test::sphereViews(4, 48);
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i].world_from_camera.translation().x() += 50 * static_cast<double>(i);
  writeScan(views);
  EXPECT_THAT(complaint("scan out.ply"), StartsWith("views: "));
  fs::remove_all(folder / "scan");
  for (View& view : views) view.map.depth = Image<float>(48, 48);
  writeScan(views);
  EXPECT_EQ(complaint("scan out.ply"), "views: no view has a valid depth");
}

TEST_F(FuseTool, OutputsThatCannotBeWrittenAreRefusedBeforeTheWork) {
  EXPECT_THAT(complaint("scan no/out.ply"), StartsWith("no/out.ply: "));
  EXPECT_THAT(complaint("scan out.ply --json no/out.json"), StartsWith("no/out.json: "));
  EXPECT_THAT(complaint("scan out.ply --save-grids no/out.vdb"), StartsWith("no/out.vdb: "));
  // Not even the superuser can make a file there.
  EXPECT_THAT(complaint("scan /proc/out.ply --json out.json --resolution 24"), StartsWith("/proc/out.ply: "));
  EXPECT_THAT(complaint("scan scan --overwrite"), StartsWith("scan: "));
}

TEST_F(FuseTool, ADiskThatFillsUpLeavesNoneOfTheOutputsAndTheOldMesh) {
  writeText(folder / "out.ply", "precious");
  const std::string full_at_40_kB = "trap '' XFSZ && ulimit -f 80";
  const ToolResult run = runTool(
      folder, "fuse scan out.ply --overwrite --resolution 24 --save-grids out.vdb --json out.json --quiet",
      full_at_40_kB);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, StartsWith("vdbfuse: out.vdb: cannot be written: "));
  EXPECT_TRUE(readText(folder / "out.ply") == "precious");
  EXPECT_EQ(folder.entryCount(), 2u);
}

TEST_F(FuseTool, AnUnknownExtensionIsRefusedBeforeTheWork) {
  EXPECT_EQ(complaint("scan out.xyz"),
            "out.xyz: expected the extension .ply, .obj, .stl or .glb, found .xyz");
  EXPECT_EQ(complaint("scan out"), "out: expected the extension .ply, .obj, .stl or .glb, found none");
}

TEST_F(FuseTool, ADomainWithoutAnySurfaceIsAnErrorNotAnEmptyMesh) {
  EXPECT_THAT(complaint("scan out.ply --voxel 0.05 --bbox 5,5,5,6,6,6"), StartsWith("the result is empty"));
  EXPECT_EQ(complaint("scan out.ply --voxel 0.05 --bbox 5,5,5,4,6,6"),
            "--bbox: the lower corner must come first");
}

TEST_F(FuseTool, TheHeaderSaysThatTheSurfaceIsClosedTrimmedOrACurlessLevyOne) {
  const auto comments = [&](const std::string& arguments) {
    const ToolResult run =
        runTool(folder, "fuse scan a.ply --resolution 24 --overwrite --quiet " + arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string header = readText(folder / "a.ply").substr(0, 600);
    EXPECT_EQ(topology(readMesh(folder / "a.ply")).nonmanifold_vertices, 0u);
    return header.substr(0, header.find("end_header"));
  };
  EXPECT_THAT(comments(""), HasSubstr("comment closed surface\n"));
  EXPECT_THAT(comments("--trim 2"), HasSubstr("comment open: trimmed where fewer than 2 views agree\n"));
  EXPECT_GT(topology(readMesh(folder / "a.ply")).triangles, 100u);
  EXPECT_THAT(comments("--method tsdf"), HasSubstr("comment open: no surface where space is unknown"));
}

TEST_F(FuseTool, TrimmingEverythingIsAnErrorAndSaysWhy) {
  EXPECT_EQ(complaint("scan out.ply --resolution 24 --trim 1000"),
            "the result is empty: trim or min_component leaves nothing of the surface");
}

TEST_F(FuseTool, SimplifiesToANumberOfTrianglesAndStaysClosed) {
  ASSERT_EQ(runTool(folder, "fuse scan a.ply --resolution 48 --simplify 600 --quiet").exit_code, 0);
  const TriangleMesh mesh = readMesh(folder / "a.ply");
  EXPECT_LE(mesh.triangles.size(), 660u);
  EXPECT_TRUE(isClosedManifold(topology(mesh)));
  EXPECT_NEAR(signedVolume(mesh), 4.0 / 3 * M_PI * 0.125, 0.05);
}

TEST_F(FuseTool, ColoursTheMeshFromPicturesUnlessToldNotTo) {
  std::vector<View> views = test::sphereViews(16, 48);
  for (View& view : views) view.map.color = Image<Rgb8>(48, 48, Rgb8{200, 100, 50});
  fs::remove_all(folder / "scan");
  writeScan(std::move(views));
  ASSERT_EQ(runTool(folder, "fuse scan a.ply --resolution 24 --quiet").exit_code, 0);
  const TriangleMesh mesh = readMesh(folder / "a.ply");
  ASSERT_EQ(mesh.colors.size(), mesh.vertices.size());
  for (const Rgb8& color : mesh.colors) ASSERT_EQ(color, (Rgb8{200, 100, 50}));
  ASSERT_EQ(runTool(folder, "fuse scan b.ply --resolution 24 --color none --quiet").exit_code, 0);
  EXPECT_TRUE(readMesh(folder / "b.ply").colors.empty());
}

TEST_F(FuseTool, TheTsdfTakesItsOptionsAndSaysSo) {
  const ToolResult run =
      runTool(folder,
              "fuse scan a.ply --method tsdf --voxel 0.04 --truncation 0.2 --carve --weights "
              "incidence,noise --min-weight 0.1 --json a.json --save-grids a.vdb --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json options = nlohmann::json::parse(readText(folder / "a.json"))["options"];
  EXPECT_EQ(options["truncation"], 0.2);
  EXPECT_EQ(options["carve"], true);
  EXPECT_EQ(options["weights"], (nlohmann::json{"noise", "incidence"}));
  EXPECT_EQ(options["min_weight"], 0.1);
  const TsdfVolume volume = TsdfVolume::read(folder / "a.vdb");
  EXPECT_EQ(volume.options().truncation, 0.2);
  EXPECT_GT(volume.leafCount(), 10u);
  EXPECT_THAT(complaint("scan b.ply --method tsdf --truncation wide"),
              HasSubstr("expected 'auto', 'outliers' or a positive length, found 'wide'"));
  ASSERT_EQ(runTool(folder,
                    "fuse scan c.ply --method tsdf --voxel 0.04 --truncation outliers --weights none "
                    "--json c.json --quiet")
                .exit_code,
            0);
  EXPECT_TRUE(nlohmann::json::parse(readText(folder / "c.json"))["options"]["weights"].empty());
  EXPECT_LT(nlohmann::json::parse(readText(folder / "c.json"))["options"]["truncation"], 0.12);
}

TEST_F(FuseTool, GoesOnWithAVolumeThatWasSaved) {
  ASSERT_EQ(
      runTool(folder, "fuse scan a.ply --method tsdf --voxel 0.04 --save-grids a.vdb --quiet").exit_code, 0);
  const ToolResult run =
      runTool(folder, "fuse scan b.ply --continue a.vdb --save-grids b.vdb --json b.json --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // The same views twice: the same distances, and twice the weight.
  const ScalarGrid once = readGrid(folder / "a.vdb", "weight"), twice = readGrid(folder / "b.vdb", "weight");
  ASSERT_EQ(once.leafCount(), twice.leafCount());
  for (std::size_t leaf = 0; leaf < once.leafCount(); ++leaf)
    for (std::size_t k = 0; k < ScalarGrid::kLeafSize; ++k)
      ASSERT_EQ(2 * once.leaf(leaf).values[k], twice.leaf(leaf).values[k]);
  EXPECT_EQ(nlohmann::json::parse(readText(folder / "b.json"))["options"]["voxel"], 0.04);
  const ScalarGrid other("surface", {0.04}, kUnknown);
  writeGrids(folder / "other.vdb", {&other});
  EXPECT_THAT(complaint("scan c.ply --continue other.vdb"), HasSubstr("a float grid named 'weight'"));
  EXPECT_EQ(runTool(folder, "fuse scan c.ply --continue a.vdb --voxel 0.02 --quiet").exit_code, 2);
}

TEST_F(FuseTool, ReadersOfOtherFormatsOfMeshesGetThem) {
  for (const std::string name : {"a.obj", "a.stl"}) {
    ASSERT_EQ(runTool(folder, "fuse scan --resolution 24 --quiet " + name).exit_code, 0);
    EXPECT_GT(readMesh(folder / name).triangles.size(), 500u);
  }
}

TEST_F(FuseTool, WrongUsageExitsWithTwoAndTouchesNothing) {
  for (const std::string wrong :
       {"fuse scan", "fuse scan out.ply --voxel -1", "fuse scan out.ply --voxel 0.1 --resolution 9",
        "fuse scan out.ply --rule sometimes", "fuse scan out.ply --bbox 1,2,3",
        "fuse scan out.ply --frobnicate", "fuse scan out.ply --threads -1", "fuse scan out.ply --border wall",
        ""}) {
    const ToolResult run = runTool(folder, wrong);
    EXPECT_EQ(run.exit_code, 2) << wrong;
    EXPECT_NE(run.err, "") << wrong;
  }
  EXPECT_EQ(folder.entryCount(), 1u);
  EXPECT_EQ(runTool(folder, "fuse --help").exit_code, 0);
}

}  // namespace
}  // namespace vdbfuse
