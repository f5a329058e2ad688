// SPDX-License-Identifier: Apache-2.0
// The evidence as a sum over views: each adds its testimony to a few numbers a point, and can take it away
// again.
#pragma once

#include <span>

#include "fusion/block_kernels.h"
#include "vdbfuse/fusion/evidence.h"

namespace vdbfuse {

/// The sums of some points, side by side.
struct TestimonySums {
  std::span<float> nodes;    ///< nodeCount() a point
  std::span<float> reports;  ///< Σ w share of the views that measured something
  std::span<float> heard;    ///< Σ w of the same
  std::span<float> empties;  ///< Σ w of the views whose sensor met nothing
  std::span<float> masked;   ///< Σ w of the views whose silhouette leaves the point out

  TestimonySums part(std::size_t first, std::size_t count) const;
};

class TestimonySum {
 public:
  /// `total_weight`: of all views that will ever be added at the same time; decides how many nodes are
  /// needed.
  TestimonySum(const SensorModel& sensor, double miss_rate, const EvidenceOptions& options,
               double total_weight);

  std::size_t nodeCount() const { return static_cast<std::size_t>(integral_.nodeCount()); }

  /// Adds (weight > 0) or removes (weight < 0) a view at the points of a block.
  void add(const PreparedView& view, const PointBlock& block, float weight, const TestimonySums& sums) const;

  /// e of each point.
  void finish(const TestimonySums& sums, float* evidence) const;

 private:
  void addOutside(const PreparedView& view, const PointBlock& block, float weight,
                  const TestimonySums& sums) const;
  void addPaper(const PreparedView& view, const PointBlock& block, float weight,
                const TestimonySums& sums) const;
  void addNoSelfOcclusion(const PreparedView& view, const PointBlock& block, float weight,
                          const TestimonySums& sums) const;
  void finishOutside(const TestimonySums& sums, float* evidence) const;
  float maskTerm(float masked) const;

  EvidenceOptions options_;
  SensorModel sensor_;
  LikelihoodRatio ratio_;
  VisibilityIntegral integral_;
  float no_return_, mask_, thickness_;
};

}  // namespace vdbfuse
