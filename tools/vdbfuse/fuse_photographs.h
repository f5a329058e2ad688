// SPDX-License-Identifier: Apache-2.0
// What fuse does when its input is photographs: depth maps first, in memory.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <vector>

#include "sensor_options.h"
#include "stereo_report.h"
#include "vdbfuse/base/progress.h"
#include "vdbfuse/stereo/stereo_options.h"

namespace vdbfuse::tool {

/// As given on the command line.
struct PhotographArguments {
  StereoOptions stereo;
  bool forced = false;              ///< --from-images
  std::vector<CLI::Option*> given;  ///< those that mean something for photographs only
};

/// --from-images and addStereoOptions(). `arguments` must outlive the parsing.
void addPhotographOptions(CLI::App& app, PhotographArguments& arguments);

/// Whether the input is to be taken as photographs. Throws InvalidArgument when options were given that mean
/// nothing for what it is.
bool takesPhotographs(const std::filesystem::path& input, const SensorArguments& sensor,
                      const PhotographArguments& arguments);

struct MatchedScan {
  DepthSet set;  ///< with pictures, masks and further hypotheses
  StereoSummary stereo;
};

/// Matches the photographs within the domain and the depths that `sensor` and `options` name. Sets
/// options.noise to what the matching says where no option speaks of the noise.
MatchedScan matchPhotographs(const std::filesystem::path& input, const SensorArguments& sensor,
                             const PhotographArguments& arguments, ReconstructOptions& options, Words words,
                             const Progress& progress);

}  // namespace vdbfuse::tool
