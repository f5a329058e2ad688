// SPDX-License-Identifier: Apache-2.0
// vdbfuse compare, first half: every method is run, and what is not kept in memory goes to the folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fuse_report.h"
#include "run_options.h"
#include "sensor_options.h"
#include "vdbfuse/evaluation/evaluate.h"
#include "vdbfuse/pipeline/compare.h"
#include "vdbfuse/report/slice.h"

namespace vdbfuse::tool {

struct CompareRequest : RunArguments {
  std::filesystem::path input, output, reference;
  SensorArguments sensor;
  ReconstructOptions options;
  std::vector<std::string> methods = {"visibility", "tsdf"};
  std::vector<double> taus;
  std::string up = "auto", slice = "auto", color = "auto";
  std::size_t triangles = 100000;  ///< at most, of each mesh in the page
};

/// A picture in the folder; empty where the method has nothing of the kind.
using PictureFile = std::filesystem::path;

/// What is kept of a method.
struct MethodRecord {
  std::string name;
  std::filesystem::path mesh;       ///< in the folder: meshes/NAME.ply
  Json fuse;                        ///< as fuse --json would write it
  double seconds = 0;               ///< all of it
  double shared_seconds = 0;        ///< of that, reading and judging, which all methods share
  std::size_t peak_memory = 0;      ///< largest of all steps, bytes
  std::size_t own_peak_memory = 0;  ///< without those that are shared
  PeakMemory measured = PeakMemory::Restarted;
  TopologyReport topology;
  std::optional<double> invented_share;  ///< of the area; none for the TSDF, which invents nothing
  double mean_support = 0;               ///< of the area
  std::optional<Evaluation> evaluation;
  PictureFile distance_slice, evidence_slice, weight_slice, cell_slice;
};

struct CompareRun {
  std::string format;
  std::size_t views = 0, width = 0, height = 0;
  double voxel = 0;
  CalibrationReport calibration;
  SlicePlane plane;
  Box box;  ///< of the slices
  std::vector<ViewHeader> cameras;
  std::vector<MethodRecord> methods;
};

/// The options of the methods that were asked for. Throws InvalidArgument.
std::vector<MethodToCompare> methodsOf(const CompareRequest& request);

/// Runs them all; meshes and slices lie in `folder` afterwards. Throws as reconstruct() does, and IoError.
CompareRun runMethods(const CompareRequest& request, const std::filesystem::path& folder,
                      const Progress& progress);

}  // namespace vdbfuse::tool
