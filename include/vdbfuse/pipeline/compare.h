// SPDX-License-Identifier: Apache-2.0
// Several methods on the same scan: judged once, with the same voxels and the same extractor.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vdbfuse/base/memory.h"
#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {

struct MethodToCompare {
  std::string name;
  ReconstructOptions options;
};

struct ComparedMethod {
  std::string name;
  ReconstructOptions options;  ///< with the voxel that all methods have
  /// Its steps begin with those of the judgement, which all methods have in common.
  Reconstruction result;
  /// Largest resident memory while this method ran, the judged views included, bytes; no other method's.
  std::size_t peak_memory_bytes = 0;
  /// SinceTheStart: the system does not tell methods apart, and the peak is the largest so far.
  PeakMemory measured = PeakMemory::Restarted;
};

/// Gives each method to `take` when it is done, in the order of the list: what `take` does not keep is gone
/// before the next one begins and does not count as its memory. Each result is that of
/// reconstruct(scan, options) with the first one's voxel, domain and depth prior. Throws InvalidArgument when
/// there is no method or one cannot be used, before any begins; and as reconstruct() does.
void compareMethods(JudgedScan scan, const std::vector<MethodToCompare>& methods,
                    const std::function<void(ComparedMethod)>& take, const Progress& progress = {});

}  // namespace vdbfuse
