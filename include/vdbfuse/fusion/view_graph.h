// SPDX-License-Identifier: Apache-2.0
// Which views look at a place from nearly the same side: neighbours for judging, weights for redundancy.
#pragma once

#include <cstddef>
#include <vector>

#include "vdbfuse/sensor/view.h"

namespace vdbfuse {

/// Distance between poses that reads as an angle: with f = (optic axis, position / typical depth) it is |f_i
/// − f_j|/√2, in radians. For cameras that circle an object at that depth it is the angle between them.
class ViewGraph {
 public:
  /// `typical_depth`: median depth of the data, same unit as the poses. REQUIRES: typical_depth > 0.
  ViewGraph(const std::vector<const ViewHeader*>& views, double typical_depth);

  /// Views by increasing angle from view `index`, itself left out.
  const std::vector<std::size_t>& byAngle(std::size_t index) const { return order_[index]; }
  double angle(std::size_t a, std::size_t b) const;

 private:
  std::vector<Eigen::Matrix<float, 6, 1>> features_;
  std::vector<std::vector<std::size_t>> order_;
};

struct NeighbourOptions {
  std::size_t count = 10;      ///< neighbours a view; more see more mistakes and cost time in proportion
  double min_angle_deg = 5.0;  ///< from this view and from each other; halved until `at_least` are found
  std::size_t at_least = 4;
};

/// For each view the nearest views that are still different enough to make mistakes of their own.
std::vector<std::vector<std::size_t>> chooseNeighbours(const ViewGraph& graph, std::size_t views,
                                                       const NeighbourOptions& options = {});

/// All views, each as near as may be to the one before it: neighbours in space come near each other in the
/// order.
std::vector<std::size_t> pathThrough(const ViewGraph& graph, std::size_t views);

/// w_i = 1/Σ_j exp(−(θ_ij/θ₀)²), θ₀ = 5° halved until Σ w ≥ min(0.9 N, 12): a video repeats its mistakes.
std::vector<double> redundancyWeights(const ViewGraph& graph, std::size_t views);

}  // namespace vdbfuse
