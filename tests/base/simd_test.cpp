// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/simd.h"

#include <gmock/gmock.h>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

TEST(Simd, AtLeastOneTargetIsThereAndEachCanBeUsed) {
  const std::vector<std::string> targets = simdTargets();
  ASSERT_FALSE(targets.empty());
  for (const std::string& target : targets) EXPECT_NO_THROW(useSimdTarget(target)) << target;
  EXPECT_EQ(simdTargets(), targets) << "the list must not depend on what is used";
  useSimdTarget(targets.front());
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
