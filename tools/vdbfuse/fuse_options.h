// SPDX-License-Identifier: Apache-2.0
// The options of vdbfuse fuse.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "fuse_photographs.h"
#include "run_options.h"
#include "sensor_options.h"

namespace vdbfuse::tool {

/// As given on the command line.
struct FuseRequest : RunArguments {
  std::filesystem::path input, output, judgement, grids, volume;
  SensorArguments sensor;
  PhotographArguments photographs;
  ReconstructOptions reconstruct;
  std::string border = "auto", thickness = "auto", color = "auto", truncation = "auto";
  std::vector<std::string> weights;
  bool carve = false, explain = false;
};

/// `request` must outlive the parsing.
void addFuseOptions(CLI::App& app, FuseRequest& request);

/// What is not yet in request.reconstruct. Throws InvalidArgument, and IoError for --continue.
void resolve(FuseRequest& request);

/// As --weights takes them; "none" when there is none.
std::vector<std::string> weightNames(const WeightOptions& weights);

}  // namespace vdbfuse::tool
