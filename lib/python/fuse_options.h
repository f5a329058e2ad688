// SPDX-License-Identifier: Apache-2.0
// Keywords of fuse(), judge() and Scanner.finish(): the names of the command line's options.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "python/options.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace vdbfuse::python {

struct FuseRequest {
  ReconstructOptions options;
  std::filesystem::path judgement;  ///< a folder, or empty
  bool has_colors = true;           ///< from the pictures, where there are any
  int threads = 0;                  ///< 0: all processors
};

/// Some of confidence, noise, incidence, silhouette; or none.
WeightOptions weightsOf(const OptionValue& value);

/// What judging depends on: bbox, noise, sensor, noise_scale, outliers, no_reliability, no_denial, no_return,
/// memory, threads.
const std::vector<Option<FuseRequest>>& sensorOptions();
/// All of them.
const std::vector<Option<FuseRequest>>& fuseOptions();

}  // namespace vdbfuse::python
