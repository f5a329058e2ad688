// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/io/temporary_path.h"

#include "io/temporary_folder.h"
#include "vdbfuse/io/atomic_file.h"

namespace vdbfuse {
namespace {

using test::TemporaryFolder;
using test::writeText;

TEST(TemporaryPath, GoesWithAllThatIsInIt) {
  const TemporaryFolder folder;
  {
    const TemporaryPath path(folder / "begun");
    std::filesystem::create_directory(path.path());
    writeText(path.path() / "file", "half");
  }
  EXPECT_EQ(folder.entryCount(), 0u);
}

TEST(TemporaryPath, StaysWhenItIsKept) {
  const TemporaryFolder folder;
  {
    TemporaryPath path(folder / "done");
    writeText(path.path(), "whole");
    path.keep();
  }
  EXPECT_EQ(folder.entryCount(), 1u);
}

TEST(RemoveTemporaryPaths, RemovesAllThatAreBegunAndNothingElse) {
  const TemporaryFolder folder;
  writeText(folder / "mine", "stays");
  const TemporaryPath begun(folder / "begun");
  std::filesystem::create_directories(begun.path() / "deeper");
  const AtomicFile file(folder / "mine");
  writeText(file.temporaryPath(), "half");
  AtomicFile done(folder / "done");
  done.commit();
  removeTemporaryPaths();
  EXPECT_EQ(folder.entryCount(), 2u);
  EXPECT_EQ(test::readText(folder / "mine"), "stays");
}

}  // namespace
}  // namespace vdbfuse
