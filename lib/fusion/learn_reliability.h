// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "fusion/pixel_testimony.h"
#include "vdbfuse/fusion/reliability.h"

namespace vdbfuse {

/// Bin of each measured pixel's confidence, all 0 when there is none.
class ConfidenceBins {
 public:
  explicit ConfidenceBins(const std::vector<View>& views);
  bool informative() const { return !ends_.empty(); }
  const std::vector<float>& ends() const { return ends_; }
  std::uint8_t binOf(float confidence) const;
  /// Takes the place of all views' confidence: one image a view; empty images without confidence.
  std::vector<Image<std::uint8_t>> replace(std::vector<View>& views) const;

 private:
  std::vector<float> ends_;
  std::array<float, 32> search_;  ///< ends_, and infinity
};

/// Number of everything observed of a pixel: confidence, answers of the neighbours, continuity, denial.
inline std::size_t outcome(std::size_t confidence, const PixelTestimony& t) {
  using T = PixelTestimony;
  return ((confidence * T::kAnswers + t.answer()) * T::kContinuities + t.continuity) * T::kDenials + t.denial;
}

/// The learned table: outlier probability of everything that can be observed of a pixel.
class ReliabilityTable {
 public:
  float outlier(std::size_t confidence, const PixelTestimony& testimony) const {
    return table_[outcome(confidence, testimony)];
  }
  double outlierShare() const { return outlier_share_; }
  const std::array<double, ReliabilityModel::kConfidences>& byConfidence() const { return by_confidence_; }

 private:
  void describe(const std::vector<double>& counts);
  friend ReliabilityTable learnReliability(const Testimonies&, const std::vector<Image<std::uint8_t>>&);
  double outlier_share_ = 0;
  std::array<double, ReliabilityModel::kConfidences> by_confidence_{};
  std::vector<float> table_;  ///< by outcome()
};

/// EM over all measured pixels. `confidence`: bins, empty images without one. A confidence that says nothing
/// has the same histogram in both classes, and does no harm.
ReliabilityTable learnReliability(const Testimonies& testimonies,
                                  const std::vector<Image<std::uint8_t>>& confidence);

}  // namespace vdbfuse
