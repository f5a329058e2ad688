// SPDX-License-Identifier: Apache-2.0
// The two halves of reconstruct(), for who wants to look at what was judged, keep it, or change it.
#pragma once

#include <memory>
#include <vector>

#include "vdbfuse/base/scratch_memory.h"
#include "vdbfuse/pipeline/plan.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace vdbfuse {

/// What a scan's pixels are worth, and what was found out about its sensor on the way.
struct JudgedScan {
  std::shared_ptr<ScratchMemory> memory;  ///< of the views, where they do not fit; outlives them
  ScanPlan plan;
  Judgement judgement;
  CalibrationReport calibration;
  std::vector<StepTime> steps;
  std::size_t width = 0, height = 0;  ///< of the first view, as it was loaded
};

/// Loads, calibrates and judges (section 2 of the algorithm). Of the options only the sensor's (noise_shape,
/// noise_scale, outliers, judge), `domain` and `memory` count. Throws as reconstruct() does.
JudgedScan judgeScan(const ViewSequence& views, const ReconstructOptions& options = {},
                     const Progress& progress = {});

/// The same as planned: planReconstruction() when a reconstruction follows.
JudgedScan judgeScan(const ViewSequence& views, const ReconstructOptions& options, ScanPlan plan,
                     const Progress& progress = {});

/// The rest: reconstruct(views, options) is reconstruct(judgeScan(views, options, planReconstruction(views,
/// options)), options). The options'
/// sensor does not count any more; their domain, where given, replaces the judgement's.
Reconstruction reconstruct(JudgedScan scan, const ReconstructOptions& options = {},
                           const Progress& progress = {});

}  // namespace vdbfuse
