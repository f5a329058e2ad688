// SPDX-License-Identifier: Apache-2.0
// Keywords of TSDF() and of Scanner().
#pragma once

#include <vector>

#include "python/options.h"
#include "vdbfuse/pipeline/scanner.h"

namespace vdbfuse::python {

/// voxel, truncation, colors, storage, weights, min_weight, sensor, bbox. The options of a TSDF are
/// ScannerOptions::preview.
const std::vector<Option<ScannerOptions>>& previewOptions();

}  // namespace vdbfuse::python
