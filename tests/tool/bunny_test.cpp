// SPDX-License-Identifier: Apache-2.0
// The range scans of the Stanford bunny, from files to a mesh, against the mesh that was made from them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/shared_data.h"
#include "io/temporary_folder.h"
#include "tool/run_tool.h"

namespace vdbfuse {
namespace {

using test::quoted;
using test::runTool;
using test::TemporaryFolder;
using testing::HasSubstr;

struct RealData : testing::Test {
  std::filesystem::path scans = test::sharedData("bunny-scans").value_or("");
  void SetUp() override {
    if (scans.empty()) GTEST_SKIP() << "no bunny-scans in ../shared/data or $VDBFUSE_DATA";
  }
};

TEST_F(RealData, BunnyScansBecomeAClosedMeshWithinAQuarterOfAMillimetre) {
  const TemporaryFolder folder;
  const auto mesh = folder / "bunny.ply", json = folder / "bunny.json";
  ASSERT_EQ(runTool("fuse " + quoted(scans) + " " + quoted(mesh) + " --quiet").exit_code, 0);
  ASSERT_EQ(runTool("evaluate " + quoted(mesh) + " " + quoted(scans / "reference/bun_zipper.ply") +
                    " --tau 0.00025 --json " + quoted(json))
                .exit_code,
            0);
  const auto found = nlohmann::json::parse(test::readText(json));
  // Nine tenths of the surface lie nearer than this, so half of it does.
  EXPECT_LT(found["accuracy90"], 0.00025);
  EXPECT_GT(found["completeness"], 0.99);
  EXPECT_EQ(found["components"], 1);
  EXPECT_EQ(found["open_edges"], 0);
}

TEST_F(RealData, BunnyScansWithThePlainQuaternionAreWarnedOf) {
  const auto plain = runTool("info " + quoted(scans) + " --fix-convention transposed");
  EXPECT_THAT(plain.err, HasSubstr("warning: the views disagree with each other"));
  EXPECT_THAT(plain.err, HasSubstr("rotations are transposed (quaternions conjugated)"));
  EXPECT_THAT(plain.err, HasSubstr("Try --fix-convention transposed\n"));
  EXPECT_EQ(runTool("info " + quoted(scans)).err, "");
}

}  // namespace
}  // namespace vdbfuse
