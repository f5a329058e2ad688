// SPDX-License-Identifier: Apache-2.0
#include "stereo/votes_of_one_pixel.h"

#include <algorithm>
#include <cmath>

namespace vdbfuse::test {
namespace {

// Calls use(peak, weighted score) for the best peak of every voter.
template <class Use>
void forEachVoter(const std::vector<Peak>& peaks, float sigma, float step, const Use& use) {
  for (std::size_t i = 0; i < peaks.size();) {
    const int voter = peaks[i].voter;
    const Peak* best = nullptr;
    float best_score = 0;
    for (; i < peaks.size() && peaks[i].voter == voter; ++i) {
      const float place = std::abs(peaks[i].step - step) / sigma;
      const float score = place < 4 ? peaks[i].score * std::exp(-place * place / 2) : 0.0F;
      if (score > best_score) best = &peaks[i], best_score = score;
    }
    if (best != nullptr) use(*best, best_score);
  }
}

float shifted(const std::vector<Peak>& peaks, float sigma, float step) {
  for (int i = 0; i < 4; ++i) {
    float sum = 0, place = 0;
    forEachVoter(peaks, sigma, step, [&](const Peak& peak, float score) {
      sum += score * peak.curvature, place += score * peak.curvature * peak.step;
    });
    if (sum > 0) step = place / sum;
  }
  return step;
}

Mode modeAt(const std::vector<Peak>& peaks, float sigma, float step) {
  Mode mode;
  mode.step = step;
  float weights = 0;
  forEachVoter(peaks, sigma, step, [&](const Peak& peak, float score) {
    (peak.is_partner ? mode.score : mode.support) += score;
    const float distance = peak.step - step;
    if (!peak.is_partner || std::abs(distance) > 2 * sigma) return;
    ++mode.voters;
    mode.spread2 += score * distance * distance, weights += score;
  });
  if (weights > 0) mode.spread2 /= weights;
  return mode;
}

}  // namespace

float countAt(const std::vector<Peak>& peaks, float sigma, float step) {
  float sum = 0;
  forEachVoter(peaks, sigma, step, [&](const Peak&, float score) { sum += score; });
  return sum;
}

std::vector<Mode> modesOf(const std::vector<Peak>& peaks, float sigma, std::size_t most) {
  std::vector<float> counts;
  for (const Peak& peak : peaks) counts.push_back(countAt(peaks, sigma, peak.step));
  std::vector<Mode> modes;
  while (modes.size() < most) {
    const auto best = std::max_element(counts.begin(), counts.end());
    if (best == counts.end() || *best <= 0) break;
    const auto index = static_cast<std::size_t>(best - counts.begin());
    Mode mode = modeAt(peaks, sigma, shifted(peaks, sigma, peaks[index].step));
    for (std::size_t i = 0; i < peaks.size(); ++i)
      if (i == index || std::abs(peaks[i].step - mode.step) < 3 * sigma) counts[i] = 0;
    mode.second = *std::max_element(counts.begin(), counts.end());
    modes.push_back(mode);
  }
  return modes;
}

}  // namespace vdbfuse::test
