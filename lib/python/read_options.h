// SPDX-License-Identifier: Apache-2.0
// Keywords that say how stored numbers are to be understood: those of read(), and the part of them that
// arrays need.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "python/options.h"
#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse::python {

struct ReadRequest : ReadOptions {
  std::string fix_convention = "none";  ///< "auto", or a list of conventionNamed()
  std::size_t views = 0;                ///< the first ones only; 0: all
};

/// depth_scale, depth_kind, baseline, min_depth, max_depth.
const std::vector<Option<ReadRequest>>& depthOptions();
/// These, and format, intrinsics, splat_step, masks, fix_convention, views.
const std::vector<Option<ReadRequest>>& readOptions();

/// "z", "range", "disparity" or "inverse".
const char* nameOf(DepthKind kind);

}  // namespace vdbfuse::python
