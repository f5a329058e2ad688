// SPDX-License-Identifier: Apache-2.0
// A tiny valid data set of every format, for the tests that try all of them: detection, damage, fuzzing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vdbfuse::test {

struct Sample {
  std::string format;
  /// What is special about it, in one or two words; part of the names of tests.
  std::string variant;
  /// Writes it into an existing empty folder.
  void (*write)(const std::filesystem::path& folder);
  /// What is handed to readDepthSet(), relative to the folder; empty: the folder.
  std::string input;
};

/// At least one of every format of depthSetFormats().
const std::vector<Sample>& samples();

}  // namespace vdbfuse::test
