// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/version.h"

#include <gtest/gtest.h>

#include <string>

namespace vdbfuse {
namespace {

const std::string kMajorMinor =
    std::to_string(VDBFUSE_VERSION_MAJOR) + "." + std::to_string(VDBFUSE_VERSION_MINOR);

TEST(Version, TheTextIsMadeOfTheThreeNumbers) {
  EXPECT_EQ(VDBFUSE_VERSION, kMajorMinor + "." + std::to_string(VDBFUSE_VERSION_PATCH));
}

TEST(Version, TheBuildHasTheVersionOfTheHeaders) {
  EXPECT_STREQ(VDBFUSE_VERSION, VDBFUSE_PROJECT_VERSION);
  EXPECT_STREQ(VDBFUSE_VERSION, version());
}

TEST(Version, EveryMinorVersionHasItsOwnSoversionBeforeOne) {
  EXPECT_EQ(VDBFUSE_SOVERSION,
            VDBFUSE_VERSION_MAJOR == 0 ? kMajorMinor : std::to_string(VDBFUSE_VERSION_MAJOR));
}

TEST(Version, AtLeastComparesMajorThenMinorThenPatch) {
  constexpr int kMajor = VDBFUSE_VERSION_MAJOR, kMinor = VDBFUSE_VERSION_MINOR,
                kPatch = VDBFUSE_VERSION_PATCH;
  EXPECT_TRUE(VDBFUSE_VERSION_AT_LEAST(kMajor, kMinor, kPatch));
  EXPECT_TRUE(VDBFUSE_VERSION_AT_LEAST(kMajor, kMinor - 1, kPatch + 1));
  EXPECT_FALSE(VDBFUSE_VERSION_AT_LEAST(kMajor, kMinor, kPatch + 1));
  EXPECT_FALSE(VDBFUSE_VERSION_AT_LEAST(kMajor, kMinor + 1, 0));
  EXPECT_FALSE(VDBFUSE_VERSION_AT_LEAST(kMajor + 1, 0, 0));
}

}  // namespace
}  // namespace vdbfuse
