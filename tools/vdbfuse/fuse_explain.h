// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/resolved.h"
#include "fuse_options.h"
#include "vdbfuse/pipeline/parameters.h"

namespace vdbfuse::tool {

/// What a run of fuse found for what the command line left open, and how: from what it goes on with, the
/// judged scan and its parameters. `format`: of the data set.
std::vector<FoundValue> foundValues(const FuseRequest& request, const JudgedScan& scan,
                                    const Parameters& parameters, const std::string& format);

}  // namespace vdbfuse::tool
