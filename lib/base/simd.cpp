// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/simd.h"

#include <hwy/highway.h>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

// A bit a set of instructions, the best one lowest.
std::vector<std::int64_t> usableTargets() {
  hwy::DisableTargets(0);
  const std::int64_t all = hwy::SupportedTargets() & HWY_TARGETS;
  std::vector<std::int64_t> targets;
  for (std::int64_t target = 1; target > 0 && target <= all; target <<= 1)
    if ((all & target) != 0) targets.push_back(target);
  return targets;
}

}  // namespace

std::vector<std::string> simdTargets() {
  std::vector<std::string> names;
  for (const std::int64_t target : usableTargets()) names.emplace_back(hwy::TargetName(target));
  return names;
}

void useSimdTarget(const std::string& name) {
  std::string known;
  for (const std::int64_t target : usableTargets()) {
    known += (known.empty() ? "" : ", ") + std::string(hwy::TargetName(target));
    if (name != hwy::TargetName(target)) continue;
    hwy::DisableTargets(target - 1);
    return;
  }
  throw InvalidArgument("simd", "expected one of " + known + ", found '" + name + "'");
}

}  // namespace vdbfuse
