// SPDX-License-Identifier: Apache-2.0
#include "python/report.h"

namespace vdbfuse::python {
namespace {

py::list boxOf(const Box& box) {
  py::list numbers;
  for (const Eigen::Vector3d& corner : {Eigen::Vector3d(box.min()), Eigen::Vector3d(box.max())})
    for (const double number : corner) numbers.append(number);
  return numbers;
}

py::dict calibrationOf(const CalibrationReport& c) {
  return py::dict("noise_scale"_a = c.noise_scale, "noise_law"_a = nameOfLaw(c.noise_exponent),
                  "median_depth"_a = c.median_depth, "point_spacing"_a = c.point_spacing, "near"_a = c.near,
                  "far"_a = c.far, "miss_rate"_a = c.miss_rate, "outlier_share"_a = c.outlier_share,
                  "confidence_direction"_a = nameOf(c.confidence));
}

py::dict gridOf(const GridReport& grid) {
  return py::dict("voxel"_a = grid.voxel, "bbox"_a = boxOf(grid.domain), "active"_a = grid.active,
                  "leaves"_a = grid.leaves, "cells"_a = grid.cells, "levels"_a = grid.cells_by_level);
}

py::dict cutOf(const CutReportSummary& cut) {
  return py::dict("flow"_a = cut.flow, "certified"_a = cut.certified, "nodes"_a = cut.nodes,
                  "arcs"_a = cut.arcs, "lambda"_a = cut.lambda, "least_cost"_a = cut.least_cost,
                  "visibility_prior"_a = cut.visibility_prior, "thickness"_a = cut.thickness,
                  "border"_a = nameOf(cut.border), "cavities_filled"_a = cut.cavities.filled,
                  "cavities_volume"_a = cut.cavities.volume, "specks_removed"_a = cut.specks.removed,
                  "specks_volume"_a = cut.specks.volume, "unresolved_removed"_a = cut.unresolved);
}

py::dict energyOf(const CutEnergy& energy) {
  return py::dict("total"_a = energy.surface + energy.volume, "surface"_a = energy.surface,
                  "volume"_a = energy.volume, "metric"_a = "faces");
}

py::dict completionOf(const CompletionReport& completion) {
  return py::dict("primal"_a = completion.primal, "dual"_a = completion.dual, "area"_a = completion.area,
                  "iterations"_a = completion.iterations);
}

}  // namespace

py::list stepsOf(const std::vector<StepTime>& steps) {
  py::list list;
  for (const StepTime& step : steps)
    list.append(py::dict("name"_a = step.name, "seconds"_a = step.seconds, "cpu_seconds"_a = step.cpu_seconds,
                         "peak_memory_bytes"_a = step.peak_memory_bytes));
  return list;
}

py::dict reportOf(const Reconstruction& result) {
  py::dict report("calibration"_a = calibrationOf(result.calibration), "grid"_a = gridOf(result.grid),
                  "invented_area_share"_a = result.invented_area_share,
                  "components_dropped"_a = result.components_dropped,
                  "simplify_error"_a = result.simplify_error,
                  "memory"_a = py::dict("budget_bytes"_a = result.memory.budget,
                                        "estimated_bytes"_a = result.memory.estimated,
                                        "view_window_bytes"_a = result.memory.window),
                  "steps"_a = stepsOf(result.steps));
  if (!result.cut) {
    report["truncation"] = result.truncation;
    return report;
  }
  report["energy"] = energyOf(result.cut->energy);
  report["cut"] = cutOf(*result.cut);
  if (result.cut->completion) report["completion"] = completionOf(*result.cut->completion);
  return report;
}

}  // namespace vdbfuse::python
