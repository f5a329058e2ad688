// SPDX-License-Identifier: Apache-2.0
// As damaged_files_test.cpp, for sets of photographs.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "formats/damage.h"
#include "formats/image_samples.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/formats/image_set.h"

namespace vdbfuse {
namespace {

using test::Sample;

constexpr int kTrials = test::kSanitized ? 50 : 300;

// Whether it was refused.
bool isRefused(const std::filesystem::path& input, const std::string& format) {
  try {
    const ImageSet set = readImageSet(input, {format, {}});
    EXPECT_FALSE(set.photographs.empty());
    for (std::size_t i = 0; i < set.photographs.size(); ++i) set.photographs.load(i);
    return false;
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return true;
  }
}

class DamagedImageSets : public testing::TestWithParam<Sample> {};

TEST_P(DamagedImageSets, AreReadOrRefused) { test::expectReadOrRefused(GetParam(), kTrials, isRefused); }

INSTANTIATE_TEST_SUITE_P(Formats, DamagedImageSets, testing::ValuesIn(test::imageSamples()),
                         [](const auto& test) { return test.param.format + "_" + test.param.variant; });

}  // namespace
}  // namespace vdbfuse
