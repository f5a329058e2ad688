// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

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

}  // namespace vdbfuse::test
