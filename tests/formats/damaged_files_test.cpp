// SPDX-License-Identifier: Apache-2.0
// Files with random damage are read or refused, never worse: no crash, no hang, no memory beyond a gibibyte,
// no empty result. Worth most under the sanitizers.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "formats/damage.h"
#include "formats/samples.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse {
namespace {

namespace fs = std::filesystem;
using test::Sample;

constexpr int kTrials = test::kSanitized ? 150 : 1000;

// Whether it was refused.
bool isRefused(const fs::path& input, const std::string& format) {
  ReadOptions options;
  options.format = format;
  try {
    const DepthSet set = readDepthSet(input, options);
    EXPECT_FALSE(set.views.empty());
    for (std::size_t i = 0; i < set.views.size(); ++i) set.views.load(i);
    return false;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return true;
  }
}

class DamagedFiles : public testing::TestWithParam<Sample> {};

TEST_P(DamagedFiles, AreReadOrRefused) { test::expectReadOrRefused(GetParam(), kTrials, isRefused); }

INSTANTIATE_TEST_SUITE_P(Formats, DamagedFiles, testing::ValuesIn(test::samples()),
                         [](const auto& test) { return test.param.format + "_" + test.param.variant; });

}  // namespace
}  // namespace vdbfuse
