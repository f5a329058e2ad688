// SPDX-License-Identifier: Apache-2.0
// What a reconstruction will cost, found out from a first look at a few small images before the work begins.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vdbfuse/base/progress.h"
#include "vdbfuse/pipeline/reconstruct.h"
#include "vdbfuse/sensor/view_sequence.h"

namespace vdbfuse {

/// What the first look tells.
struct Survey {
  Box domain;              ///< the one given, or where the views looked at agree
  double area = 0;         ///< of the measured surfaces in the domain, length²
  double stray_share = 0;  ///< share of all pixels that measured something in the domain and are not believed
  double noise_scale = 0;  ///< at the median depth
  double median_depth = 0;
  double point_spacing = 0;  ///< of neighbouring measurements of the full images, length
};

/// How a scan is worked through.
struct ScanPlan {
  /// Nothing when the views looked at agree nowhere; then only what the views need is known.
  std::optional<Survey> survey;
  double voxel = 0;  ///< expected
  double cells = 0;  ///< expected; voxels for the TSDF
  /// Images of view i are made this many times smaller: where pixels are finer than half a voxel's footprint.
  std::vector<int> reduction;
  std::size_t memory_budget = 0;     ///< bytes that may be used
  std::size_t estimated_memory = 0;  ///< bytes at the peak
  /// Views lie in a scratch file and this many bytes of them in memory; 0: all in memory.
  std::size_t window_bytes = 0;
  std::vector<StepTime> steps;  ///< of making it; the first ones of what follows
};

/// Looks at up to 32 views spread over the sequence. `options`: those of reconstruct(). Throws what loading
/// views throws, and InvalidArgument when the reconstruction would need more memory than options.memory: the
/// message says how much, and what voxel size would fit.
ScanPlan planReconstruction(const ViewSequence& views, const ReconstructOptions& options = {},
                            const Progress& progress = {});

/// The plan for judging alone, which loads nothing. Throws InvalidArgument when not even a few views fit.
ScanPlan planJudging(const ViewSequence& views, const ReconstructOptions& options = {});

}  // namespace vdbfuse
