// SPDX-License-Identifier: Apache-2.0
// The two halves of reconstruct(JudgedScan, ...), for scans that are fused more than once.
#pragma once

#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {

/// The options' domain and depth prior take the place of those the scan was judged with.
void useOptions(const ReconstructOptions& options, JudgedScan& scan);

/// Fuses what useOptions() has prepared, and leaves it as it is. Throws as reconstruct() does. REQUIRES:
/// usable options.
Reconstruction fuseJudged(const JudgedScan& scan, const ReconstructOptions& options,
                          const Progress& progress);

}  // namespace vdbfuse
