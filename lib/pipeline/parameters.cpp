// SPDX-License-Identifier: Apache-2.0
#include "vdbfuse/pipeline/parameters.h"

#include <algorithm>

#include "pipeline/steps.h"

namespace vdbfuse {
namespace {

double chooseTruncation(const TsdfMethod& method, double voxel, const CalibrationReport& calibration) {
  if (method.start) return method.start->options().truncation;
  if (method.truncation > 0) return method.truncation;
  if (method.otherwise == TsdfMethod::Truncation::FromOutliers)
    return truncationFor(calibration.noise_scale,
                         std::clamp<double>(calibration.outlier_share, kMinOutlier, kMaxOutlier));
  return std::max(4 * voxel, 3 * calibration.noise_scale);
}

}  // namespace

Parameters resolveParameters(const JudgedScan& scan, const ReconstructOptions& options) {
  const CalibrationReport& calibration = scan.calibration;
  Parameters p;
  p.domain = options.domain.value_or(scan.judgement.domain);
  const VoxelChoice voxel = chooseVoxel(p.domain, calibration, options);
  p.voxel = voxel.size, p.voxel_from = voxel.from;
  p.evidence = evidenceOptions(scan.judgement.judged, p.domain, options);
  p.cut = cutOptions(scan.judgement.judged, p.domain, GridFrame{p.voxel}, calibration, options);
  const std::vector<Eigen::Vector3d> sensors = sensorPositions(scan.judgement.judged);
  p.sensors = sensors.size(), p.sensors_inside = countInside(sensors, p.domain);
  p.truncation = chooseTruncation(options.tsdf, p.voxel, calibration);
  return p;
}

}  // namespace vdbfuse
