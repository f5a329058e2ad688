// SPDX-License-Identifier: Apache-2.0
// The options of every subcommand that makes depth maps from photographs.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "json_file.h"
#include "vdbfuse/formats/image_set.h"
#include "vdbfuse/stereo/stereo_options.h"

namespace vdbfuse::tool {

/// --mode, --neighbours, --min-angle, --max-angle, --window, --hypotheses, --min-confidence,
/// --surface-sweeps,
/// --no-cross-check; in a group of that name in the help. `options` must outlive the parsing. Returns them.
std::vector<CLI::Option*> addStereoOptions(CLI::App& app, StereoOptions& options, const std::string& group);

/// The photographs, and not more than `most` of them; 0: all. Throws as readImageSet().
ImageSet readPhotographs(const std::filesystem::path& path, const ImageReadOptions& options,
                         std::size_t most);

/// All of them, as they are used.
Json jsonOf(const StereoOptions& options);

}  // namespace vdbfuse::tool
