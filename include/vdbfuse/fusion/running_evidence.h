// SPDX-License-Identifier: Apache-2.0
// Evidence while scanning: for given reliabilities it is a sum over views, so that a view can be added the
// moment it arrives, and taken away again.
#pragma once

#include <memory>
#include <vector>

#include "vdbfuse/fusion/evidence.h"
#include "vdbfuse/volume/scalar_grid.h"

namespace vdbfuse {

struct RunningEvidenceOptions {
  EvidenceOptions evidence;
  double miss_rate = 0.5;  ///< of the sensor, for no-returns (JudgedViews::miss_rate)
  /// Σ of the weights of the views that will be in the sum at the same time, at most; more of them blur the
  /// smallest visibilities. Memory a voxel: 4 (4 + nodes) bytes, nodes = 8 up to 256 views with the default
  /// prior.
  double most_views = 256;
};

/// Sums of the views' testimony at the voxels of given leaves. The order of the views does not matter and a
/// view that was added and removed leaves no trace, both up to rounding.
class RunningEvidence {
 public:
  /// `leaf_origins`: multiples of 8. Throws InvalidArgument for unusable options.
  RunningEvidence(const SensorModel& sensor, const GridFrame& frame, std::vector<Index3> leaf_origins,
                  const RunningEvidenceOptions& options = {});
  ~RunningEvidence();
  RunningEvidence(RunningEvidence&&) noexcept;
  RunningEvidence& operator=(RunningEvidence&&) noexcept;

  /// Every voxel hears the view with its weight. Parallel over leaves, the same sums for any number of
  /// threads.
  void add(const JudgedView& view);
  /// Takes away what add() of the same view, with the same reliabilities and weight, has added.
  void remove(const JudgedView& view);

  /// σ at every voxel: grid "sigma", background 0.
  ScalarGrid evidence() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vdbfuse
