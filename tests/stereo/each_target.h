// SPDX-License-Identifier: Apache-2.0
// Runs kernels on each instruction set that they are compiled for and the processor has.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace vdbfuse::test {

template <class Body>
void forEachTarget(const Body& body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body();
  }
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace vdbfuse::test
