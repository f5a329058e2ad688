// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/atomic_file.h"

#include <gmock/gmock.h>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::readText;
using test::TemporaryFolder;
using test::writeText;
using testing::EndsWith;

TEST(AtomicFile, CommitReplacesTheTargetAndLeavesNothingElse) {
  const TemporaryFolder folder;
  writeText(folder / "out.ply", "old");
  AtomicFile file(folder / "out.ply");
  writeText(file.temporaryPath(), "new");
  EXPECT_EQ(readText(folder / "out.ply"), "old");
  file.commit();
  EXPECT_EQ(readText(folder / "out.ply"), "new");
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(AtomicFile, WithoutCommitTheOldFileStaysAndTheTemporaryGoes) {
  const TemporaryFolder folder;
  writeText(folder / "out.ply", "old");
  {
    const AtomicFile file(folder / "out.ply");
    writeText(file.temporaryPath(), "half");
  }
  EXPECT_EQ(readText(folder / "out.ply"), "old");
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(AtomicFile, TheTemporaryLiesBesideTheTargetAndKeepsItsExtension) {
  const TemporaryFolder folder;
  const AtomicFile file(folder / "out.ply");
  EXPECT_EQ(file.temporaryPath().parent_path(), folder.path());
  EXPECT_EQ(file.temporaryPath().extension(), ".ply");
}

TEST(AtomicFile, TwoWritersOfOneTargetDoNotShareATemporary) {
  const TemporaryFolder folder;
  const AtomicFile a(folder / "out.ply"), b(folder / "out.ply");
  EXPECT_NE(a.temporaryPath(), b.temporaryPath());
}

TEST(AtomicFile, ALinkStaysALinkToTheNewContent) {
  const TemporaryFolder folder;
  writeText(folder / "real", "old");
  std::filesystem::create_symlink(folder / "real", folder / "link");
  AtomicFile file(folder / "link");
  writeText(file.temporaryPath(), "new");
  file.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(readText(folder / "real"), "new");
}

TEST(AtomicFile, AMissingFolderIsNamedInTheError) {
  const TemporaryFolder folder;
  const std::string target = (folder / "missing/out.ply").string();
  EXPECT_EQ(messageOf<IoError>([&] { AtomicFile file(target); }),
            target + ": expected a folder that can be written to, found No such file or directory");
}

TEST(AtomicFile, AFolderAsTargetIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THAT(messageOf<IoError>([&] { AtomicFile file(folder.path()); }),
              EndsWith("expected a file to write, found a folder"));
}

TEST(AtomicFile, ADeviceAsTargetIsRefused) {
  EXPECT_EQ(messageOf<IoError>([] { AtomicFile file("/dev/null"); }),
            "/dev/null: expected a regular file to write, found a special file");
}

TEST(AtomicFile, ATargetThatBecameAFolderFailsAtCommitAndLeavesNoTemporary) {
  const TemporaryFolder folder;
  {
    AtomicFile file(folder / "out");
    std::filesystem::create_directories(folder / "out" / "inner");
    EXPECT_THAT(messageOf<IoError>([&] { file.commit(); }), testing::HasSubstr("cannot be put in place"));
  }
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(WriteTogether, PutsAllInPlace) {
  const TemporaryFolder folder;
  writeTogether({{folder / "a.ply", [](const auto& path) { writeText(path, "A"); }},
                 {folder / "b.json", [](const auto& path) { writeText(path, "B"); }}});
  EXPECT_EQ(readText(folder / "a.ply"), "A");
  EXPECT_EQ(readText(folder / "b.json"), "B");
  EXPECT_EQ(folder.entryCount(), 2u);
}

TEST(WriteTogether, OneFailureLeavesNoneAndNamesItsTarget) {
  const TemporaryFolder folder;
  writeText(folder / "a.ply", "old");
  const auto write = [&] {
    writeTogether({{folder / "a.ply", [](const auto& path) { writeText(path, "A"); }},
                   {folder / "b.json", [](const auto& path) { throw IoError(path, "the disk is full"); }}});
  };
  EXPECT_EQ(messageOf<IoError>(write), (folder / "b.json").string() + ": the disk is full");
  EXPECT_EQ(readText(folder / "a.ply"), "old");
  EXPECT_EQ(folder.entryCount(), 1u);
}

}  // namespace
}  // namespace vdbfuse
