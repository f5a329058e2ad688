// SPDX-License-Identifier: Apache-2.0
// The small decisions between the big steps of reconstruct().
#pragma once

#include "vdbfuse/fusion/calibrate.h"
#include "vdbfuse/fusion/domain.h"
#include "vdbfuse/pipeline/judge_scan.h"
#include "vdbfuse/pipeline/parameters.h"

namespace vdbfuse {

void requireUsable(const ReconstructOptions& options);
void requireUsable(const ViewSequence& views, const ReconstructOptions& options);

/// All views as scan.plan wants them, without their colours, in scan.memory where they do not fit; and their
/// size.
std::vector<View> loadViews(const ViewSequence& views, JudgedScan& scan, const Progress& progress);

ViewGraph makeGraph(const std::vector<View>& views, const DepthStatistics& depths);

SensorModel calibrateSensor(const std::vector<View>& views, const ViewGraph& graph,
                            const DepthStatistics& depths, const ReconstructOptions& options,
                            CalibrationReport& report, const Progress& progress);

Judgement judgeViews(std::vector<View> views, const SensorModel& sensor, const ViewGraph& graph,
                     const ReconstructOptions& options, CalibrationReport& report, const Progress& progress);

/// Reconstructs there, whatever place was judged.
void useDomain(const Box& domain, Judgement& judgement);

struct VoxelChoice {
  double size = 0;
  Parameters::VoxelFrom from = Parameters::VoxelFrom::Voxel;
};
VoxelChoice chooseVoxel(const Box& domain, const CalibrationReport& calibration,
                        const ReconstructOptions& options);

/// Voxels at integer multiples of the voxel size from the world's origin.
GridFrame chooseFrame(const Box& domain, const CalibrationReport& calibration,
                      const ReconstructOptions& options);

OctreeOptions octreeOptions(const GridFrame& frame, const CalibrationReport& calibration,
                            const ReconstructOptions& options);

CutOptions cutOptions(const JudgedViews& judged, const Box& domain, const GridFrame& frame,
                      const CalibrationReport& calibration, const ReconstructOptions& options);

/// Width of the smallest things that the depth maps can tell from nothing: the noise, or the window that a
/// depth comes from. `reduction`: ScanPlan::reduction.
double leastWidth(const std::vector<int>& reduction, const CalibrationReport& calibration,
                  const ReconstructOptions& options);

EvidenceOptions evidenceOptions(const JudgedViews& judged, const Box& domain,
                                const ReconstructOptions& options);

std::size_t countInside(const std::vector<Eigen::Vector3d>& points, const Box& box);

std::vector<Eigen::Vector3d> sensorPositions(const JudgedViews& judged);

/// Normals, support of each vertex and the share of the area without any.
void describeVertices(const ScalarGrid& support, double mu, Reconstruction& result);

GridReport describeGrid(const Octree& octree, const ScalarGrid& support, const Box& domain);
GridReport describeGrid(const ScalarGrid& field, const Box& domain);

}  // namespace vdbfuse
