// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/base/simd.h"

#include <hwy/highway.h>

#include "vdbfuse/base/errors.h"

namespace vdbfuse {
namespace {

// A bit a set of instructions, the best one lowest.
std::vector<std::int64_t> bitsOf(std::int64_t all) {
  std::vector<std::int64_t> targets;
  for (std::int64_t target = 1; target > 0 && target <= all; target <<= 1)
    if ((all & target) != 0) targets.push_back(target);
  return targets;
}

std::vector<std::int64_t> usableTargets() { return bitsOf(hwy::SupportedTargets() & HWY_TARGETS); }

std::vector<std::string> namesOf(const std::vector<std::int64_t>& targets) {
  std::vector<std::string> names;
  for (const std::int64_t target : targets) names.emplace_back(hwy::TargetName(target));
  return names;
}

}  // namespace

std::vector<std::string> simdTargets() { return namesOf(usableTargets()); }

std::vector<std::string> builtSimdTargets() { return namesOf(bitsOf(HWY_TARGETS)); }

void useSimdTarget(const std::string& name) {
  hwy::DisableTargets(0);
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
