// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "json_file.h"
#include "vdbfuse/formats/depth_set.h"
#include "vdbfuse/formats/image_set.h"
#include "vdbfuse/fusion/conventions.h"

namespace vdbfuse::tool {

/// ReadOptions, and what is done to the views after reading.
struct ReadArguments : ReadOptions {
  /// "none", "auto", or a list of conventionNamed().
  std::string fix_convention = "none";
};

/// The options of every subcommand that reads a data set: --format, --depth-scale, --depth-kind, --baseline,
/// --intrinsics, --splat-step, --masks, --min-depth, --max-depth, --fix-convention. `arguments` must outlive
/// the parsing.
void addReadOptions(CLI::App& command, ReadArguments& arguments);

enum class InputKind { DepthMaps, Photographs };

/// What lies at `path`, of the format of that name where one is given: photographs when it is no complete set
/// of depth maps, but one of photographs. Where it is neither, depth maps: their reader says what is missing.
InputKind kindOf(const std::filesystem::path& path, const std::string& format);

/// A data set under the convention that was asked for, or found; a note says which.
DepthSet readInput(const std::filesystem::path& path, const ReadArguments& arguments);

/// Says on stderr that another convention would make the views agree, where there is one: most bad fusions
/// come from poses or depths that mean something else.
void warnOf(const ConventionCheck& check);
/// The same after a quick look: no other convention is tried where the views agree well enough.
void warnOf(const DepthSet& set);

/// "z", "range", "disparity" or "inverse", as on the command line.
const char* nameOf(DepthKind kind);

/// As given: null where nothing was.
Json jsonOf(const ReadArguments& arguments);

/// "16-bit PNG, z, times 0.001; invalid: 0 and 65535".
std::string depthText(const DepthReading& reading);

}  // namespace vdbfuse::tool
