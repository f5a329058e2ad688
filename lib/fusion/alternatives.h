// SPDX-License-Identifier: Apache-2.0
// Pixels with several hypotheses: each is judged as if it were a view of its own, then they compete.
#pragma once

#include <vector>

#include "fusion/learn_reliability.h"
#include "fusion/pixel_testimony.h"
#include "vdbfuse/sensor/judged_view.h"

namespace vdbfuse {

/// The alternatives of all views as views of their own, in order.
class AlternativeViews {
 public:
  /// Appends a view for each alternative depth behind `views`; they keep their shares only.
  explicit AlternativeViews(std::vector<View>& views);

  /// Index of the appended views of a view.
  const std::vector<std::vector<std::size_t>>& of() const { return of_; }

  /// Appends to each list of neighbours those of the appended views: their parents'.
  void extend(std::vector<std::vector<std::size_t>>& neighbours) const;

  /// Moves the appended views' depths back into the alternatives of their parents.
  void restore(std::vector<View>& views) const;

 private:
  std::vector<std::vector<std::size_t>> of_;
};

/// Lets the hypotheses of each pixel of view `index` compete: with q_k its share before and o_k = (1 −
/// ε_k)/ε_k the odds that it is right, judged alone, its share is q_k o_k / Σ q_j o_j and the pixel's ε =
/// 1/(1 + Σ q_j o_j). The likeliest becomes `depth`, with its incidence. REQUIRES: view.outlier holds ε of
/// `depth`.
void weighAlternatives(const AlternativeViews& alternatives, std::size_t index,
                       const Testimonies& testimonies, const Image<std::uint8_t>& confidence,
                       const ReliabilityTable& table, const std::vector<CompactSurface>& surfaces,
                       JudgedView& view);

}  // namespace vdbfuse
