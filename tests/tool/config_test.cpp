// SPDX-License-Identifier: Apache-2.0
// --config, --save-config, --explain, and what is said of mistyped words.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tool/run_tool.h"

namespace vdbfuse::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// A folder with a small scan in it.
const TemporaryFolder& scanFolder() {
  static const TemporaryFolder folder;
  static const bool made = [] {
    const ToolResult run = runTool(folder, "synth figure scan --views 12 --size 96x72 --quiet");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return true;
  }();
  EXPECT_TRUE(made);
  return folder;
}

std::string inScan(const std::string& name) { return quoted(scanFolder() / name); }

// What is said of a command line that is not understood, without the word on the help.
std::string usageComplaint(const TemporaryFolder& folder, const std::string& arguments) {
  const ToolResult run = runTool(folder, arguments);
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_EQ(run.out, "");
  return run.err.substr(0, run.err.find('\n'));
}

TEST(Usage, AMistypedOptionSuggestsTheNearOne) {
  const TemporaryFolder folder;
  EXPECT_EQ(usageComplaint(folder, "fuse scan mesh.ply --voxl 0.1"),
            "vdbfuse fuse: unknown option '--voxl'; did you mean '--voxel'?");
  EXPECT_EQ(usageComplaint(folder, "fuse scan --resoluton=3"),
            "vdbfuse fuse: unknown option '--resoluton'; did you mean '--resolution'?");
  EXPECT_EQ(usageComplaint(folder, "convert scan out --too colmap"),
            "vdbfuse convert: unknown option '--too'; did you mean '--to'?");
}

TEST(Usage, AMistypedCommandSuggestsTheNearOne) {
  EXPECT_EQ(usageComplaint(TemporaryFolder(), "fues scan mesh.ply"),
            "vdbfuse: unknown command 'fues'; did you mean 'fuse'?");
}

TEST(Usage, AMistypedWordSuggestsTheNearOne) {
  EXPECT_EQ(usageComplaint(TemporaryFolder(), "fuse scan mesh.ply --method visibilty"),
            "vdbfuse fuse: --method: 'visibilty' is none of tsdf, visibility; did you mean 'visibility'?");
}

TEST(Usage, WhatIsMissingIsNamed) {
  const TemporaryFolder folder;
  EXPECT_EQ(usageComplaint(folder, "fuse"), "vdbfuse fuse: INPUT and OUT are missing");
  EXPECT_EQ(usageComplaint(folder, "convert a b"), "vdbfuse convert: --to is missing");
  EXPECT_EQ(usageComplaint(folder, "fuse a b.ply --voxel"),
            "vdbfuse fuse: --voxel needs a value: --voxel LENGTH");
  EXPECT_THAT(usageComplaint(folder, ""), StartsWith("vdbfuse: a command is missing: one of fuse, "));
}

TEST(Usage, WhatIsTooMuchIsNamed) {
  EXPECT_EQ(usageComplaint(TemporaryFolder(), "fuse a b.ply c"),
            "vdbfuse fuse: 'c' is one argument too many");
}

TEST(Usage, ANumberOutOfRangeSaysWhatWasExpected) {
  const TemporaryFolder folder;
  EXPECT_EQ(usageComplaint(folder, "fuse a b.ply --voxel -1"),
            "vdbfuse fuse: --voxel: expected a number above 0, found '-1'");
  EXPECT_EQ(usageComplaint(folder, "fuse a b.ply --visibility 2"),
            "vdbfuse fuse: --visibility: expected a number from 0 to 1, found '2'");
}

TEST(Config, TheSavedRunGivesTheSameMeshAgain) {
  const TemporaryFolder folder;
  const ToolResult first = runTool(
      folder, "fuse " + inScan("scan") + " a.ply --resolution 32 --trim 0.3 --save-config run.toml --quiet");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const ToolResult again = runTool(folder, "fuse --config run.toml --output b.ply --quiet");
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(readText(folder / "a.ply"), readText(folder / "b.ply"));
}

TEST(Config, TheSavedRunNamesEveryOptionAndTheVersion) {
  const TemporaryFolder folder;
  const ToolResult run =
      runTool(folder, "fuse " + inScan("scan") + " a.ply --resolution 32 --save-config run.toml --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string saved = readText(folder / "run.toml");
  EXPECT_THAT(saved, HasSubstr("version = \""));
  EXPECT_THAT(saved, HasSubstr("\ninput = \"" + (scanFolder() / "scan").string() + "\"\n"));
  EXPECT_THAT(saved, HasSubstr("\noutput = \"" + (folder / "a.ply").string() + "\"\n"));
  EXPECT_THAT(saved, HasSubstr("\nresolution = 32\n"));
  EXPECT_THAT(saved, HasSubstr("\nmu = 2\n"));
  EXPECT_THAT(saved, HasSubstr("\ncarve = false\n"));
  EXPECT_THAT(saved, HasSubstr("\n# lambda: "));
}

TEST(Config, TheCommandLineWinsOverTheFile) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "[fuse]\nresolution = 16\nmethod = \"tsdf\"\n");
  const ToolResult run = runTool(
      folder, "fuse " + inScan("scan") + " a.ply --config run.toml --resolution 24 --json a.json --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(readText(folder / "a.json"));
  EXPECT_EQ(json["options"]["method"], "tsdf");
  const auto& box = json["options"]["bbox"];
  double longest = 0;
  for (int a = 0; a < 3; ++a) longest = std::max(longest, box[a + 3].get<double>() - box[a].get<double>());
  EXPECT_NEAR(longest / json["options"]["voxel"].get<double>(), 24, 1e-6);
}

TEST(Config, AnOptionThatExcludesOneOfTheFileReplacesIt) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "resolution = 16\n");
  const ToolResult run =
      runTool(folder, "fuse " + inScan("scan") + " --explain --config run.toml --voxel 0.05 --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, testing::ContainsRegex("\nvoxel +0\\.05 +command line\n"));
}

TEST(Config, AnUnknownKeyIsAnErrorWithItsLineAndTheNearKey) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "[fuse]\n\nvoxle = 0.1\n");
  EXPECT_EQ(usageComplaint(folder, "fuse a b.ply --config run.toml"),
            "vdbfuse fuse: run.toml, line 3: unknown key 'voxle'; did you mean 'voxel'?");
}

TEST(Config, AnUnknownSectionIsAnError) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "[fues]\nvoxel = 0.1\n");
  EXPECT_EQ(usageComplaint(folder, "fuse a b.ply --config run.toml"),
            "vdbfuse fuse: run.toml, line 1: unknown section [fues]; did you mean 'fuse'?");
}

TEST(Config, AWrongValueIsAnErrorWithItsLine) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "[fuse]\nvoxel = -1\n");
  EXPECT_EQ(usageComplaint(folder, "fuse a b.ply --config run.toml"),
            "vdbfuse fuse: run.toml, line 2: --voxel: expected a number above 0, found '-1'");
  writeText(folder / "run.toml", "[fuse]\ncarve = 3\n");
  EXPECT_EQ(usageComplaint(folder, "fuse a b.ply --config run.toml"),
            "vdbfuse fuse: run.toml, line 2: expected true or false for 'carve', found '3'");
  writeText(folder / "run.toml", "[fuse]\nbbox = [0, 0, 1]\n");
  EXPECT_THAT(usageComplaint(folder, "fuse a b.ply --config run.toml"),
              HasSubstr("run.toml, line 2: --bbox"));
}

TEST(Config, AFileThatIsNoTomlOrIsNotThereIsAnError) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "[fuse]\nvoxel 0.1\n");
  EXPECT_THAT(usageComplaint(folder, "fuse a b.ply --config run.toml"), HasSubstr("run.toml, line 2: "));
  EXPECT_THAT(usageComplaint(folder, "fuse a b.ply --config none.toml"), HasSubstr("none.toml"));
}

TEST(Config, SectionsOfOtherCommandsDoNotCount) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "views = 3\n[synth]\nsize = \"48x36\"\n[fuse]\nvoxel = 0.1\n");
  const ToolResult run = runTool(folder, "synth sphere scan --config run.toml");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 views 48x36"));
}

TEST(Config, AnExistingFileIsNotReplacedUnlessAsked) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "mine");
  const ToolResult run = runTool(folder, "synth sphere scan --views 2 --size 32x24 --save-config run.toml");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("run.toml: exists already"));
  EXPECT_EQ(readText(folder / "run.toml"), "mine");
}

TEST(Explain, SaysOfEachParameterWhereItComesFromAndWritesNothing) {
  const TemporaryFolder folder;
  writeText(folder / "run.toml", "[fuse]\n\nmu = 3\n");
  const ToolResult run =
      runTool(folder, "fuse " + inScan("scan") + " --explain --resolution 32 --config run.toml --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, StartsWith("parameter"));
  EXPECT_THAT(run.out, testing::ContainsRegex("\nresolution +32 +command line\n"));
  EXPECT_THAT(run.out, testing::ContainsRegex("\nmu +3 +run.toml, line 3\n"));
  EXPECT_THAT(run.out, testing::ContainsRegex("\nrule +outside +default\n"));
  EXPECT_THAT(run.out, testing::ContainsRegex("\nborder +outside +0 of 12 sensors are inside the domain\n"));
  EXPECT_EQ(folder.entryCount(), 1u);
}

// The value in a row of the table.
double valueOf(const std::string& table, const std::string& name) {
  std::istringstream row(table.substr(table.find("\n" + name + " ") + 1));
  std::string key;
  double value = 0;
  row >> key >> value;
  return value;
}

TEST(Explain, TellsWhatTheRunThenUses) {
  const TemporaryFolder folder;
  const std::string options = "fuse " + inScan("scan") + " --quiet --trim 0.3";
  const ToolResult told = runTool(folder, options + " --explain");
  const ToolResult done = runTool(folder, options + " --output a.ply --json a.json");
  ASSERT_EQ(told.exit_code, 0) << told.err;
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto used = nlohmann::json::parse(readText(folder / "a.json"))["options"];
  for (const char* name : {"voxel", "lambda", "thickness", "trim"})
    EXPECT_NEAR(valueOf(told.out, name) / used[name].get<double>(), 1, 1e-5) << name;
}

TEST(Quiet, AndJsonOnStandardOutputLeaveNoWordsThere) {
  const TemporaryFolder folder;
  const std::vector<std::string> commands = {"info " + inScan("scan"),
                                             "fuse " + inScan("scan") + " a.ply --resolution 16",
                                             "render a.ply a.png --size 64x48",
                                             "formats",
                                             "evaluate a.ply " + inScan("scan/truth.ply"),
                                             "judge " + inScan("scan") + " judged",
                                             "convert " + inScan("scan") + " rgbd --to rgbd",
                                             "synth sphere s --views 2 --size 32x24"};
  for (const std::string& command : commands) {
    const ToolResult run = runTool(folder, command + " --json -");
    ASSERT_EQ(run.exit_code, 0) << command << run.err;
    const auto json = nlohmann::json::parse(run.out, nullptr, false);
    EXPECT_TRUE(json.is_object()) << command << run.out;
  }
  EXPECT_EQ(runTool(folder, "info " + inScan("scan") + " --quiet").out, "");
}

}  // namespace
}  // namespace vdbfuse::test
