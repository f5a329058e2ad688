// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "io/temporary_folder.h"

namespace vdbfuse::test {

struct ToolResult {
  int exit_code = -1;
  std::string out, err;
};

/// A path as one word of a shell. REQUIRES: no single quote in it.
inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

/// Runs `vdbfuse ARGUMENTS` by the shell: quote paths with quoted().
inline ToolResult runTool(const std::string& arguments) {
  const TemporaryFolder streams;
  const std::filesystem::path out = streams / "out", err = streams / "err";
  const std::string command =
      quoted(VDBFUSE_TOOL) + " " + arguments + " >" + quoted(out) + " 2>" + quoted(err);
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(out), readText(err)};
}

/// The same with `folder` as the working folder; `before` is run by the same shell, for its limits.
inline ToolResult runTool(const TemporaryFolder& folder, const std::string& arguments,
                          const std::string& before = "true") {
  const TemporaryFolder streams;
  const std::filesystem::path out = streams / "out", err = streams / "err";
  const std::string command = "cd " + quoted(folder.path()) + " && " + before + " && " +
                              quoted(VDBFUSE_TOOL) + " " + arguments + " >" + quoted(out) + " 2>" +
                              quoted(err);
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(out), readText(err)};
}

/// What the tool says when it must fail: one line, exit code 1, nothing new in the folder.
inline std::string complaintOf(const TemporaryFolder& folder, const std::string& arguments) {
  const std::size_t before = folder.entryCount();
  const ToolResult run = runTool(folder, arguments + " --quiet");
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(folder.entryCount(), before) << "something was left behind";
  return run.err;
}

}  // namespace vdbfuse::test
