// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "json_file.h"
#include "stereo_report.h"
#include "vdbfuse/mesh/topology.h"
#include "vdbfuse/pipeline/plan.h"

namespace vdbfuse::tool {

/// What a run of fuse knows besides its result.
struct FuseContext {
  std::filesystem::path input, judgement;
  std::string format;
  std::size_t views = 0;
  ReconstructOptions options;
  TopologyReport topology;
  std::optional<StereoSummary> stereo;  ///< of photographs
};

/// One object: version, command, options (resolved), input, calibration, grid, energy, cut, mesh, steps,
/// memory.
Json fuseJson(const Reconstruction& result, const FuseContext& context);

double totalSeconds(const std::vector<StepTime>& steps);

/// What is about to be done and what it will take, on stderr.
void printPlan(const ScanPlan& plan, Method method);

/// A few lines on stdout.
void printFuseReport(const Reconstruction& result, const FuseContext& context,
                     const std::filesystem::path& output);

}  // namespace vdbfuse::tool
