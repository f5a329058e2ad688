// SPDX-License-Identifier: Apache-2.0
// The options of every subcommand that judges a data set: what to read, the sensor, the place.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "read_options.h"
#include "vdbfuse/pipeline/reconstruct.h"

namespace vdbfuse::tool {

/// As given on the command line.
struct SensorArguments {
  ReadArguments read;
  std::size_t views = 0;
  std::vector<double> box;
  std::string outliers = "auto", noise = "gaussian", sensor;
  bool no_reliability = false, no_denial = false;
};

/// --bbox, --views, --noise, --sensor, --noise-scale, --outliers, --no-reliability, --no-denial, --no-return
/// and all of addReadOptions(). Both structs must outlive the parsing. Returns the options that a judgement
/// made before answers already.
std::vector<CLI::Option*> addSensorOptions(CLI::App& app, SensorArguments& arguments,
                                           ReconstructOptions& options);

/// --voxel and --resolution.
void addVoxelOptions(CLI::App& app, ReconstructOptions& options);

/// --color auto|none: whether the mesh gets colours from the input's pictures.
void addColorOption(CLI::App& app, std::string& color);

/// What of the arguments is not yet in the options. Throws InvalidArgument.
void resolve(const SensorArguments& arguments, ReconstructOptions& options);

/// A text that is a number and nothing else.
std::optional<double> parseNumber(const std::string& text);

enum class Words { Print, Keep };

/// The data set cut to --views; its notes go to stderr.
DepthSet readScan(const std::filesystem::path& input, const SensorArguments& arguments, Words words,
                  ReadOptions::Color color = ReadOptions::Color::Skip);

/// The views with their pictures; none where there are no pictures. Looks at one view: data sets have
/// pictures for all of them, or for none.
ViewSequence withPictures(ViewSequence views);
/// The same of the data set that readScan() gives.
ViewSequence readPictures(const std::filesystem::path& input, const SensorArguments& arguments);

}  // namespace vdbfuse::tool
