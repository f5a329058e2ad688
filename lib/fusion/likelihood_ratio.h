// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "vdbfuse/sensor/noise_model.h"

namespace vdbfuse {

/// logLikelihoodRatio() for many points: F from a table. Within 2e-3 of it for ε ≥ 0.003.
/// REQUIRES: a finite range.
class LikelihoodRatio {
 public:
  static constexpr int kSteps = 4096;
  static constexpr float kReach = 16.0f;  // beyond this many scales F is 0 or 1
  /// Points nearer to an end of the range than this share of it are taken to lie there.
  static constexpr float kEnd = 0.001f;

  explicit LikelihoodRatio(const SensorModel& sensor);

  /// One depth that an inlier may have measured.
  struct Peak {
    float depth, noise, share;
  };

  /// Sums over the peaks of what inliers say; then log() of both.
  struct Odds {
    float behind = 0;  ///< Σ share (F(far) − F(d))
    float before = 0;  ///< Σ share (F(d) − F(near)), over its normaliser with a thickness prior
  };

  float log(float measured, float noise, float outlier, float depth) const {
    const float d = std::clamp(depth, first_, last_);
    Odds odds;
    add({measured, noise, 1.0f}, d, odds);
    return combine(odds, outlier, d);
  }

  /// The same in steps, for several peaks: clampDepth(), add() a peak, combine().
  float clampDepth(float depth) const { return std::clamp(depth, first_, last_); }
  void add(const Peak& peak, float depth, Odds& odds) const {
    const float per_noise = 1.0f / peak.noise;
    const float before = cdf((depth - peak.depth) * per_noise);
    const float first = cdf((near_ - peak.depth) * per_noise), last = cdf((far_ - peak.depth) * per_noise);
    odds.behind += peak.share * std::max(last - before, 0.0f);
    odds.before += peak.share * (prior_decay_ > 0 ? thick(peak, depth) : std::max(before - first, 0.0f));
  }
  float combine(const Odds& odds, float outlier, float depth) const {
    const float t = (depth - near_) * per_range_;
    const float a = ((1 - outlier) * odds.behind + outlier * (1 - t)) / (1 - t);
    const float b = (1 - outlier) * odds.before * (prior_decay_ > 0 ? 1.0f : 1.0f / t) + outlier;
    return std::log(a / b);
  }

  /// Beyond so many scales F differs from 0 or 1 by less than 1e-8.
  float reach() const { return reach_; }
  bool thick() const { return prior_decay_ > 0; }
  /// F at kSteps + 2 places from −kReach to kReach and a step beyond.
  const float* table() const { return cdf_.data(); }
  float near() const { return near_; }
  float far() const { return far_; }
  float perRange() const { return per_range_; }

 private:
  static constexpr int kDecays = 32;

  float cdf(float u) const {
    const float place = (std::clamp(u, -kReach, kReach) + kReach) * (kSteps / (2 * kReach));
    const std::size_t i = static_cast<std::size_t>(place);
    return cdf_[i] + (place - static_cast<float>(i)) * (cdf_[i + 1] - cdf_[i]);
  }
  float thick(const Peak& peak, float depth) const;
  float decayed(float u, float kappa) const;

  float near_, far_, per_range_, first_, last_, prior_decay_, reach_ = kReach;
  std::vector<float> cdf_;
  std::vector<std::vector<float>> decayed_;  ///< ∫ up to u of f(y) e^(−κ(u−y)) dy, a row a κ
};

}  // namespace vdbfuse
