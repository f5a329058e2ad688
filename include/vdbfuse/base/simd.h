// SPDX-License-Identifier: Apache-2.0
// Which instructions the inner loops use. Another set gives other last digits: the same input gives the same
// result on every machine that has the set that is asked for.
#pragma once

#include <string>
#include <vector>

namespace vdbfuse {

/// The sets of vector instructions that this processor has, vdbfuse is built for, and useSimdTarget() has not
/// ruled out, best first: "AVX2", "SSE4", …
std::vector<std::string> simdTargets();

/// All that vdbfuse is built for, whatever this processor has.
std::vector<std::string> builtSimdTargets();

/// Uses this set from now on and none that is better. Not while other threads compute. Throws InvalidArgument
/// for a name that simdTargets() does not give.
void useSimdTarget(const std::string& name);

}  // namespace vdbfuse
