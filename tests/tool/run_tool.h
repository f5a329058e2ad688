// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "io/temporary_folder.h"

namespace vdbfuse::test {

struct ToolRun {
  int exit_code = -1;
  std::string output;  ///< stdout
  std::string words;   ///< stderr
};

/// A path as one word of a shell. REQUIRES: no single quote in it.
inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

/// Runs the tool with `arguments`, which a shell reads: quote paths with quoted().
inline ToolRun runTool(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder / "stdout", words = folder / "stderr";
  const std::string command =
      quoted(VDBFUSE_TOOL) + " " + arguments + " >" + quoted(output) + " 2>" + quoted(words);
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(output), readText(words)};
}

}  // namespace vdbfuse::test
