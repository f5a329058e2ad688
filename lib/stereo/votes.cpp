// SPDX-License-Identifier: Apache-2.0
#include "stereo/votes.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse::stereo {
namespace {

constexpr float kReach = 4.0F;   // of W, in sigma; beyond it is below 4e-4
constexpr int kTableSteps = 64;  // a sigma
constexpr int kShifts = 4;

std::vector<float> gaussianTable() {
  std::vector<float> table;
  for (int i = 0; i <= static_cast<int>(kReach) * kTableSteps + 1; ++i) {
    const double d = static_cast<double>(i) / kTableSteps;
    table.push_back(static_cast<float>(std::exp(-d * d / 2)));
  }
  return table;
}

}  // namespace

// Calls use(peak, weighted score) for what votes near `step`. Most peaks are far from it.
template <class Use>
inline void Voting::forEachVoter(const std::vector<Peak>& peaks, float step, const Use& use) const {
  const Peak *peak = peaks.data(), *end = peak + peaks.size();
  while (peak != end) {
    const std::int32_t partner = peak->partner;
    const Peak* best = nullptr;
    float best_score = 0;
    for (; peak != end && peak->partner == partner; ++peak) {
      const float distance = std::abs(peak->step - step);
      if (!(distance < reach_)) continue;
      const float score = peak->score * weight(distance);
      if (votes_ == PartnerVotes::All)
        use(*peak, score);
      else if (score > best_score)
        best = peak, best_score = score;
    }
    if (best != nullptr) use(*best, best_score);
  }
}

Voting::Voting(float sigma, std::size_t most_modes, PartnerVotes votes)
    : sigma_(sigma),
      reach_(kReach * sigma),
      most_modes_(most_modes),
      votes_(votes),
      table_(gaussianTable()) {}

inline float Voting::weight(float distance) const {
  const float scaled = distance / sigma_ * kTableSteps;
  const auto below = static_cast<std::int32_t>(scaled);
  const float* at = table_.data() + below;
  return at[0] + (scaled - static_cast<float>(below)) * (at[1] - at[0]);
}

float Voting::scoreAt(const std::vector<Peak>& peaks, float step) const {
  float sum = 0;
  forEachVoter(peaks, step, [&](const Peak&, float score) { sum += score; });
  return sum;
}

Mode Voting::shifted(const std::vector<Peak>& peaks, float step) const {
  Mode mode;
  for (int i = 0; i < kShifts; ++i) {
    float sum = 0, place = 0;
    forEachVoter(peaks, step, [&](const Peak& peak, float score) {
      sum += score * peak.curvature;
      place += score * peak.curvature * peak.step;
    });
    if (sum > 0) step = place / sum;
  }
  float spread2 = 0, weights = 0;
  std::int32_t last_voter = -1;
  forEachVoter(peaks, step, [&](const Peak& peak, float score) {
    const bool is_partner = peak.partner < kOtherViews;
    (is_partner ? mode.score : mode.support) += score;
    const float distance = peak.step - step;
    if (!is_partner || std::abs(distance) > 2 * sigma_) return;
    if (peak.partner != last_voter) ++mode.voters;
    last_voter = peak.partner;
    spread2 += score * distance * distance, weights += score;
  });
  mode.step = step;
  mode.spread2 = weights > 0 ? spread2 / weights : 0;
  return mode;
}

const Modes& Voting::count(const std::vector<Peak>& peaks) {
  modes_.clear();
  candidates_.clear();
  for (const Peak& peak : peaks) candidates_.emplace_back(scoreAt(peaks, peak.step), peak.step);
  while (modes_.size() < most_modes_) {
    const auto best = std::max_element(candidates_.begin(), candidates_.end(),
                                       [](const auto& a, const auto& b) { return a.first < b.first; });
    if (best == candidates_.end() || best->first <= 0) break;
    const Mode mode = shifted(peaks, best->second);
    for (auto& candidate : candidates_) {
      if (std::abs(candidate.second - mode.step) < 3 * sigma_) candidate.first = 0;
    }
    best->first = 0;
    modes_.push_back(mode);
  }
  return modes_;
}

}  // namespace vdbfuse::stereo
