// SPDX-License-Identifier: Apache-2.0
// log ∫ Beta(v; a, 1) Π_i (1 − v + v L_i)^w_i dv by quadrature. Each node k holds the sum over views of
// w_i log(1 − v_k + v_k L_i), so that views can be added in any order, and taken away again.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

namespace vdbfuse {

class VisibilityIntegral {
 public:
  /// Nodes: midpoints of equal prior mass, enough of them for `views` views. `visibility` > 0: that one v.
  VisibilityIntegral(double a, double visibility, double views);

  int nodeCount() const { return nodes_; }

  /// sums[k] += weight · log(1 − v_k + v_k L) for all nodes; from a table, to 2e-4.
  void add(float log_ratio, float weight, float* sums) const;

  /// Where the table holds log(1 − v_k + v_k L): between two rows of nodeCount() values, `share` of the way.
  struct Row {
    const float* low;
    const float* high;
    float share;
  };
  Row rowOf(float log_ratio) const {
    const float place = (std::clamp(log_ratio, -kRange, kRange) + kRange) * kStepsPerUnit;
    const int row = static_cast<int>(place);
    const float* low = table_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes_);
    return {low, low + nodes_, place - static_cast<float>(row)};
  }

  /// log of the mean over the nodes of e^sums[k].
  double logMean(const float* sums) const;

  /// −½ log ∫ Beta(v; a, 1) (1 − v)ⁿ dv: half of what n denials weigh; interpolated between whole n.
  double halfDenial(double n) const;

 private:
  static constexpr float kRange = 16.0f;
  static constexpr float kStepsPerUnit = 16.0f;
  int nodes_ = 0;
  std::vector<float> table_;  ///< row by row: log ratio, node
  std::vector<double> half_denial_;
};

}  // namespace vdbfuse
