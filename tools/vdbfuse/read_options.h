// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

#include "vdbfuse/formats/depth_set.h"

namespace vdbfuse::tool {

/// The options of every subcommand that reads a data set: --format, --depth-scale, --depth-kind, --baseline,
/// --masks, --min-depth, --max-depth. `options` must outlive the parsing.
void addReadOptions(CLI::App& command, ReadOptions& options);

/// "z", "range", "disparity" or "inverse", as on the command line.
const char* nameOf(DepthKind kind);

}  // namespace vdbfuse::tool
