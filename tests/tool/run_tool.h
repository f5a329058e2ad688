// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "io/temporary_folder.h"

namespace vdbfuse::test {

struct ToolResult {
  int exit_code;
  std::string out, err;
};

/// Runs `vdbfuse ARGUMENTS` by the shell with `folder` as the working folder.
inline ToolResult runTool(const TemporaryFolder& folder, const std::string& arguments) {
  const TemporaryFolder streams;
  const std::string out = (streams / "out").string(), err = (streams / "err").string();
  const std::string command = "cd '" + folder.path().string() + "' && '" VDBFUSE_TOOL "' " + arguments +
                              " >'" + out + "' 2>'" + err + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(out), readText(err)};
}

}  // namespace vdbfuse::test
