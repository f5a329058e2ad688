// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/simd.h"

#include <gmock/gmock.h>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

TEST(Simd, AtLeastOneTargetIsThereAndEachCanBeUsed) {
  const std::vector<std::string> targets = simdTargets();
  ASSERT_FALSE(targets.empty());
  for (const std::string& target : targets) {
    useSimdTarget(target);
    EXPECT_EQ(simdTargets().front(), target);
    EXPECT_THAT(builtSimdTargets(), testing::Contains(target));
  }
  useSimdTarget(targets.front());
  EXPECT_EQ(simdTargets(), targets);
}

TEST(Simd, AnUnknownTargetIsRefusedWithTheOnesThatAreKnown) {
  try {
    useSimdTarget("MMX");
    FAIL();
  } catch (const InvalidArgument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("found 'MMX'"));
    EXPECT_THAT(error.what(), testing::HasSubstr(simdTargets().front()));
  }
}

}  // namespace
}  // namespace vdbfuse
