// SPDX-License-Identifier: Apache-2.0
// What the options that are left open come to, once the views have been judged.
#pragma once

#include <cstddef>

#include "vdbfuse/pipeline/judge_scan.h"

namespace vdbfuse {

/// What reconstruct() works with.
struct Parameters {
  /// What decided the size of the voxel. By default it is the largest of three: the distance of neighbouring
  /// measurements, the noise, and the longest side of the domain / 512.
  enum class VoxelFrom { Voxel, Resolution, PointSpacing, Noise, LongestSide };

  double voxel = 0;
  VoxelFrom voxel_from = VoxelFrom::Voxel;
  Box domain;
  EvidenceOptions evidence;                     ///< with a and the thickness
  CutOptions cut;                               ///< with λ, ρ₀ and the border
  std::size_t sensors = 0, sensors_inside = 0;  ///< of the domain: more than half of them make a solid border
  double truncation = 0;                        ///< of Method::Tsdf, length
};

/// REQUIRES: validate(options) finds nothing. `scan` as reconstruct() gets it.
Parameters resolveParameters(const JudgedScan& scan, const ReconstructOptions& options = {});

}  // namespace vdbfuse
