// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tool/run_tool.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using test::readText;
using test::runTool;
using test::TemporaryFolder;
using test::ToolResult;
using test::writeText;
using testing::HasSubstr;
using testing::Not;

// One small scan and its comparison, for all tests that only look.
class CompareTool : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    ASSERT_EQ(runTool(*folder, "synth figure scan --arc ring --views 12 --size 96x72 --quiet").exit_code, 0);
    const ToolResult run = runTool(*folder, "compare scan out " + kOptions + " --reference scan/truth.ply");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    printed = run.out;
  }
  static void TearDownTestSuite() {
    delete folder;
    folder = nullptr;
  }

  static Json compared() { return Json::parse(readText(*folder / "out/compare.json")); }
  static std::string complaint(const std::string& arguments) { return complaintOf(*folder, arguments); }

  static const std::string kOptions;
  static TemporaryFolder* folder;
  static std::string printed;
};

const std::string CompareTool::kOptions = "--resolution 40 --triangles 2000";
TemporaryFolder* CompareTool::folder = nullptr;
std::string CompareTool::printed;

TEST_F(CompareTool, WritesThePageAndEverythingItShows) {
  for (const char* file :
       {"report.html", "compare.json", "meshes/visibility.ply", "meshes/tsdf.ply", "viewer/visibility.glb",
        "viewer/tsdf.glb", "pictures/shaded-view-tsdf.png", "pictures/shaded-side1-reference.png",
        "pictures/distance-side1-tsdf.png", "pictures/missing-view-visibility.png",
        "pictures/support-side1-tsdf.png", "slices/sigma-visibility.png", "slices/rho-visibility.png",
        "slices/cells-visibility.png", "slices/distance-tsdf.png", "slices/weight-tsdf.png",
        "histograms/distance.svg", "histograms/missing.svg", "histograms/support.svg"})
    EXPECT_TRUE(fs::exists(*folder / "out" / file)) << file;
}

TEST_F(CompareTool, ThePageLoadsNothingAndIsSmall) {
  const std::string page = readText(*folder / "out/report.html");
  EXPECT_LT(page.size(), 20'000'000u);
  for (const char* part : {"src=\"http", "href=\"http", "src=\"pictures", "@import", "url("})
    EXPECT_THAT(page, Not(HasSubstr(part)));
  for (const char* part : {"<h2>Numbers</h2>", "<h2>Viewer</h2>", "<h2>Errors</h2>", "<h2>Slices</h2>"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(CompareTool, NumbersAreThoseOfFuseAndEvaluateAlone) {
  const Json all = compared();
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string name = k == 0 ? "visibility" : "tsdf";
    SCOPED_TRACE(name);
    const ToolResult fused =
        runTool(*folder, "fuse scan " + name + ".ply --json fuse.json --overwrite --quiet " +
                             "--resolution 40 --method " + name);
    ASSERT_EQ(fused.exit_code, 0) << fused.err;
    EXPECT_EQ(readText(*folder / (name + ".ply")), readText(*folder / "out/meshes" / (name + ".ply")));
    const Json alone = Json::parse(readText(*folder / "fuse.json"));
    for (const char* part : {"mesh", "grid", "calibration", "cut", "energy"}) {
      ASSERT_EQ(all["methods"][k].contains(part), alone.contains(part)) << part;
      EXPECT_EQ(all["methods"][k].value(part, Json()), alone.value(part, Json())) << part;
    }
    ASSERT_EQ(runTool(*folder, "evaluate " + name + ".ply scan/truth.ply --json evaluate.json").exit_code, 0);
    Json evaluated = Json::parse(readText(*folder / "evaluate.json"));
    for (const char* own : {"version", "command", "options"}) evaluated.erase(own);
    EXPECT_EQ(all["methods"][k]["evaluation"], evaluated);
  }
}

TEST_F(CompareTool, TimesOfMethodsHoldTheSharedSteps) {
  for (const Json& method : compared()["methods"]) {
    double sum = 0;
    for (const Json& step : method["steps"]) sum += step["seconds"].get<double>();
    EXPECT_NEAR(method["seconds"].get<double>(), sum, 1e-9);
    EXPECT_GT(method["shared_seconds"].get<double>(), 0);
    EXPECT_LT(method["shared_seconds"].get<double>(), sum);
    EXPECT_GE(method["peak_memory_bytes"].get<double>(), method["own_peak_memory_bytes"].get<double>());
  }
}

TEST_F(CompareTool, PrintsTheNumbersSideBySide) {
  for (const char* part :
       {"visibility", "tsdf", "Open edges", "Euler number", "Accuracy", "Peak memory", "out/report.html"})
    EXPECT_THAT(printed, HasSubstr(part));
}

// Only times and memory may differ.
TEST_F(CompareTool, MeshesAndPicturesAreTheSameForOneThread) {
  ASSERT_EQ(
      runTool(*folder, "compare scan one --quiet --threads 1 " + kOptions + " --reference scan/truth.ply")
          .exit_code,
      0);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(*folder / "out")) {
    const fs::path name = fs::relative(entry.path(), *folder / "out");
    if (!entry.is_regular_file() || name == "report.html" || name == "compare.json") continue;
    EXPECT_EQ(readText(entry.path()), readText(*folder / "one" / name)) << name;
  }
}

TEST_F(CompareTool, WithoutAReferenceMeshesAreComparedWithEachOther) {
  const ToolResult run =
      runTool(*folder, "compare scan alone --methods tsdf,constant --json copy.json " + kOptions);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string page = readText(*folder / "alone/report.html");
  EXPECT_THAT(page, HasSubstr("<h2>Differences</h2>"));
  EXPECT_THAT(page, Not(HasSubstr("Against the reference")));
  EXPECT_EQ(readText(*folder / "copy.json"), readText(*folder / "alone/compare.json"));
  const Json json = Json::parse(readText(*folder / "copy.json"));
  EXPECT_EQ(json["methods"][0]["name"], "tsdf");
  EXPECT_EQ(json["methods"][1]["options"]["rule"], "constant");
  EXPECT_TRUE(json["methods"][1]["evaluation"].is_null());
}

TEST_F(CompareTool, OneMethodIsEnough) {
  ASSERT_EQ(runTool(*folder, "compare scan single --methods visibility --quiet " + kOptions).exit_code, 0);
  EXPECT_THAT(readText(*folder / "single/report.html"), Not(HasSubstr("<h2>Differences</h2>")));
}

TEST_F(CompareTool, SaysWhatItRefuses) {
  EXPECT_EQ(complaint("compare scan out"),
            "vdbfuse: out: expected an empty folder (or --overwrite), found one that is not empty\n");
  EXPECT_EQ(complaint("compare scan scan --overwrite"), "vdbfuse: OUTDIR: holds the input\n");
  EXPECT_EQ(complaint("compare scan out --overwrite --reference out/meshes/tsdf.ply"),
            "vdbfuse: OUTDIR: holds the reference\n");
  EXPECT_EQ(complaint("compare scan new --methods tsdf,tsdf"), "vdbfuse: --methods: 'tsdf' is named twice\n");
  EXPECT_EQ(complaint("compare scan new --tau 0.01"),
            "vdbfuse: --tau: needs --reference: distances are measured from it\n");
  EXPECT_EQ(complaint("compare scan new --slice q=1"),
            "vdbfuse: --slice: expected x=VALUE, y=VALUE or z=VALUE, found 'q=1'\n");
  EXPECT_THAT(complaint("compare scan new --reference nothing.ply"), HasSubstr("nothing.ply"));
  writeText(*folder / "there.json", "x");
  EXPECT_EQ(complaint("compare scan new --json there.json"),
            "vdbfuse: there.json: exists already; give --overwrite to replace it\n");
  EXPECT_EQ(runTool(*folder, "compare scan new --methods best").exit_code, 2);
}

TEST_F(CompareTool, LeavesNothingBehindWhenAViewIsDamaged) {
  ASSERT_EQ(
      std::system(
          ("cp -r " + test::quoted(*folder / "scan") + " " + test::quoted(*folder / "damaged")).c_str()),
      0);
  writeText(*folder / "damaged/depth_est/00000005.pfm", "Pf\n96 72\n-1\n");
  EXPECT_THAT(complaint("compare damaged new --resolution 40"), HasSubstr("00000005.pfm"));
}

}  // namespace
}  // namespace vdbfuse
